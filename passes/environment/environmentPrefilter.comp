// Mean radiance of the surroundings over the GGX lobe of one roughness that leaves along its normal, about each
// direction. Normals are drawn as the viewer there sees them, so that what is left of the lobe is the shadowing. Each
// direction drawn reads the mip level whose texels are as wide as its share of the lobe (Krivanek and Colbert,
// "Real-time shading with filtered importance sampling", EGSR 2008).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/scattering/ggx.glsl"
#include "shaders/scene/specular_environment.glsl"
#include "shaders/texture/filters.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, rgba32f) uniform writeonly imageBuffer uSpecular;
layout(push_constant, std430) uniform Push {
    int level;
    int samples;
} push;

/// (u, v) of a unit direction, and the sine of its angle from the poles.
vec3 latLong(vec3 d) {
    float aside = length(d.xz);
    return vec3(0.5 - realAtan2(d.x, d.z) * INV_TWO_PI, realAtan2(aside, d.y) * INV_PI, aside);
}

void main() {
    int width = prefilteredWidth(push.level), texel = int(gl_GlobalInvocationID.x);
    if (texel >= width * (width >> 1)) return;
    float s, c, sine, cosine;
    sinCosTurns(0.5 - (float(texel % width) + 0.5) / float(width), s, c);
    sinCosTurns((float(texel / width) + 0.5) / float(width), sine, cosine);
    vec3 normal = vec3(sine * s, cosine, sine * c), x, y;
    orthonormalBasis(normal, x, y);
    float roughness = float(push.level) / float(PREFILTERED_LEVELS), alpha = roughness * roughness;

    uvec4 header = texelFetch(uTextures, 0);
    MipChain chain = fetchMipChain(0);
    float texelAngle = 0.5 * TWO_PI * TWO_PI / (float(header.y) * float(header.z));
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int k = 0; k < push.samples; ++k) {
        // Hammersley's points.
        vec2 u = vec2((float(k) + 0.5) / float(push.samples), float(bitfieldReverse(uint(k)) >> 8) * exp2(-24.0));
        vec3 h = ggxSampleNormal(vec3(0.0, 0.0, 1.0), vec2(alpha), u.yx);
        vec3 wi = vec3(2.0 * h.z * h.xy, 2.0 * h.z * h.z - 1.0);
        if (wi.z > 0.0) {
            vec3 at = latLong(x * wi.x + y * wi.y + normal * wi.z);
            float share = 1.0 / (float(push.samples) * max(ggxReflectedDensity(vec3(0.0, 0.0, 1.0), h, vec2(alpha)), 1e-20));
            float ratio = share / (texelAngle * max(at.z, 1e-3));
            float level = clamp(ratio > 1.0 ? 0.5 * realLog2(ratio) : 0.0, 0.0, float(chain.levels - 1));
            float weight = 2.0 * wi.z / (wi.z + ggxStretch(wi, vec2(alpha)));
            sum += weight * sampleLevel(header, chain, at.xy, level).rgb;
            weights += weight;
        }
    }
    imageStore(uSpecular, prefilteredFirst(push.level) + texel, vec4(sum / max(weights, 1e-20), 0.0));
}
