#pragma once
/** @file GLSL of the device tests' kernels. */
#include <heliograph/kernel.hpp>

#include <string>

namespace helio::test {

/** A kernel with 64 invocations in x (or another local size), from declarations and the body of main(). */
inline Kernel kernelOf(const std::string& name, const std::string& declarations, const std::string& body,
                       const std::string& localSize = "local_size_x = 64") {
    return compileKernel(name, "#version 460\nlayout(" + localSize + ") in;\n" + declarations +
                                   "\nvoid main() {\n" + body + "\n}\n");
}

/** uOut[i] = uIn[i] * 3 + 1 over uint values. */
inline Kernel stepKernel() {
    return kernelOf("test/step",
                    "layout(std430, set = 0, binding = 0) readonly buffer In { uint values[]; } uIn;\n"
                    "layout(std430, set = 0, binding = 1) writeonly buffer Out { uint values[]; } uOut;",
                    "uint i = gl_GlobalInvocationID.x; if (i < uOut.values.length()) uOut.values[i] = "
                    "uIn.values[i] * 3u + 1u;");
}

/** uOut[i] = i + uStart. */
inline Kernel iotaKernel() {
    return kernelOf(
        "test/iota",
        "layout(push_constant) uniform Push { uint start; } uPush;\n"
        "layout(std430, set = 0, binding = 0) writeonly buffer Out { uint values[]; } uOut;",
        "uint i = gl_GlobalInvocationID.x; if (i < uOut.values.length()) uOut.values[i] = i + uPush.start;");
}

/** uSum[i] = uLeft[i] * 5 + uRight[i]. */
inline Kernel joinKernel() {
    return kernelOf("test/join",
                    "layout(std430, set = 0, binding = 0) readonly buffer Left { uint values[]; } uLeft;\n"
                    "layout(std430, set = 0, binding = 1) readonly buffer Right { uint values[]; } uRight;\n"
                    "layout(std430, set = 0, binding = 2) writeonly buffer Sum { uint values[]; } uSum;",
                    "uint i = gl_GlobalInvocationID.x; if (i < uSum.values.length()) uSum.values[i] = "
                    "uLeft.values[i] * 5u + uRight.values[i];");
}

/** uCount += 1, once. */
inline Kernel countKernel() {
    return kernelOf("test/count", "layout(std430, set = 0, binding = 0) buffer Count { uint value; } uCount;",
                    "if (gl_GlobalInvocationID.x == 0u) uCount.value += 1u;");
}

}  // namespace helio::test
