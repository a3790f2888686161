#pragma once
/** @file
 * The error classes. A programmer's mistake is an assertion, bad input or a driver's failure one of these
 * exceptions, an expected failure a return value.
 */
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace helio {

/** Base of everything the engine throws. what() is one line. */
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/** Input refused at the door. what() reads "FILE: PLACE: FAULT; REMEDY", empty parts left out. */
class InputError : public Error {
public:
    InputError(std::string file, std::string place, std::string fault, std::string remedy);
    std::string file;    ///< the file or argument at fault
    std::string place;   ///< where in it, e.g. "accessor 3" or "line 12"
    std::string fault;   ///< what is wrong
    std::string remedy;  ///< what would be right
};

/** The application asked to stop, and nothing came of the call. */
class Cancelled : public Error {
public:
    using Error::Error;
};

/** The device or its driver failed or cannot do what was asked. */
class DeviceError : public Error {
public:
    using Error::Error;
};

/** An allocation on the device failed. Names the resource and its size. */
class OutOfDeviceMemory : public DeviceError {
public:
    OutOfDeviceMemory(std::string resource, std::uint64_t bytes, std::string detail);
    std::string resource;  ///< name the resource was created with
    std::uint64_t bytes;   ///< bytes asked for
};

/** GLSL that does not compile, or SPIR-V that does not fit its use. what() holds the compiler's messages. */
class ShaderError : public Error {
public:
    using Error::Error;
};

/** One problem of a render graph. */
struct GraphProblem {
    std::string pass;      ///< pass at fault, may be empty
    std::string binding;   ///< binding at fault, may be empty
    std::string resource;  ///< resource at fault, may be empty
    std::string message;   ///< what is wrong and what to do
};

/** Every problem found when a graph was compiled, not only the first. */
class GraphError : public Error {
public:
    explicit GraphError(std::vector<GraphProblem> problems);
    std::vector<GraphProblem> problems;
};

}  // namespace helio
