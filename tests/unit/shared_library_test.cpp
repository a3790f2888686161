// The rules of the shared library's language that compilers do not check: literals are exact in float or in
// REAL(), guards follow the path, every file is listed, and built-ins of uncertain precision are not called.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = HELIOGRAPH_SOURCE_DIR;

std::string read(const fs::path& path) {
    std::ifstream file(path);
    EXPECT_TRUE(file) << path;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string withoutComments(const std::string& text) {
    return std::regex_replace(text, std::regex("//[^\n]*"), "");
}

/// Path in the repository to text without comments, for every file that shared.hpp includes.
std::map<std::string, std::string> libraryFiles() {
    std::map<std::string, std::string> files;
    const std::string list = read(kRoot / "engine/core/shared_library.inc");
    const std::regex include("#include \"([^\"]+)\"");
    for (std::sregex_iterator i(list.begin(), list.end(), include), end; i != end; ++i)
        files[(*i)[1]] = withoutComments(read(kRoot / std::string((*i)[1])));
    return files;
}

TEST(SharedLibrary, EveryFileIsListedAndItsGuardDropped) {
    const auto files = libraryFiles();
    EXPECT_GE(files.size(), 12u);
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "shaders/shared"))
        if (entry.path().extension() == ".glsl") {
            EXPECT_TRUE(files.count(fs::relative(entry.path(), kRoot).string())) << entry.path();
        }
    const std::string guardsOff = read(kRoot / "engine/core/shared_guards_off.inc");
    for (const auto& [path, text] : files) {
        std::string guard;
        for (char c : path)
            guard += std::isalnum(static_cast<unsigned char>(c)) ? static_cast<char>(std::toupper(c)) : '_';
        EXPECT_NE(text.find("#ifndef " + guard + "\n#define " + guard + "\n"), std::string::npos) << path;
        EXPECT_NE(guardsOff.find("#undef " + guard + "\n"), std::string::npos) << path;
    }
}

/// A bare literal that is not a float's exact value, or "" if there is none.
std::string inexactLiteral(const std::string& text) {
    const std::regex literal(
        R"((REAL\(\s*-?\s*)?(\b\d+\.\d*(?:[eE][-+]?\d+)?|\B\.\d+(?:[eE][-+]?\d+)?|\b\d+[eE][-+]?\d+))");
    for (std::sregex_iterator i(text.begin(), text.end(), literal), end; i != end; ++i) {
        const std::string digits = (*i)[2];
        if (!(*i)[1].matched && std::strtod(digits.c_str(), nullptr) != std::strtof(digits.c_str(), nullptr))
            return digits;
    }
    return "";
}

TEST(SharedLibrary, BareLiteralsAreExactInFloat) {
    EXPECT_EQ(inexactLiteral("x * 0.5 + 1024.0 - REAL(0.1) * REAL(-1e-7) + v2.x + a[1].y"), "");
    EXPECT_EQ(inexactLiteral("x * 0.1"), "0.1");
    EXPECT_EQ(inexactLiteral("clamp(x, 1e-6, 1.0)"), "1e-6");
    for (const auto& [path, text] : libraryFiles()) EXPECT_EQ(inexactLiteral(text), "") << path;
}

std::string openBuiltin(const std::string& text) {
    const std::regex call(
        R"(\b(sin|cos|tan|asin|acos|atan|sinh|cosh|tanh|exp|exp2|log|log2|pow|fma|inversesqrt)\s*\()");
    std::smatch match;
    return std::regex_search(text, match, call) ? match.str(1) : "";
}

TEST(SharedLibrary, NoBuiltinOfOpenPrecisionIsCalled) {
    EXPECT_EQ(openBuiltin("realSin(x) + cosKernel(x)"), "");
    EXPECT_EQ(openBuiltin("y = pow (x, 2.0)"), "pow");
    for (const auto& [path, text] : libraryFiles()) EXPECT_EQ(openBuiltin(text), "") << path;
}

}  // namespace
