#pragma once
/** @file Small mesh files made in a test. */
#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

namespace helio::test {

namespace fs = std::filesystem;

class MeshFile : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("heliograph_mesh_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return (folder_ / name).string();
    }
    Scene load(const std::string& name, const std::string& content) const {
        Scene scene = helio::load(write(name, content));
        EXPECT_NO_THROW(scene.validate());
        return scene;
    }
    /** The text of the InputError that loading must end in: one line that names the file, what is wrong and
     * what would be right. */
    std::string refusal(const std::string& name, const std::string& content) const {
        const std::string file = write(name, content);
        try {
            helio::load(file);
        } catch (const InputError& error) {
            const std::string text = error.what();
            EXPECT_EQ(text.find('\n'), std::string::npos) << text;
            EXPECT_TRUE(text.starts_with(file + ": ")) << text;
            EXPECT_FALSE(error.remedy.empty()) << text;
            return text;
        }
        ADD_FAILURE() << "loads: " << content.substr(0, 200);
        return {};
    }

    fs::path folder_;
};

/** Sum of the areas of all triangles. */
inline double areaOf(const Primitive& primitive) {
    double area = 0;
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        const glm::dvec3 a = primitive.positions[primitive.indices[i]];
        const glm::dvec3 b = primitive.positions[primitive.indices[i + 1]];
        const glm::dvec3 c = primitive.positions[primitive.indices[i + 2]];
        area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return area;
}

inline bool mentions(const std::vector<std::string>& texts, const std::string& part) {
    for (const std::string& text : texts) {
        if (text.find(part) != std::string::npos) return true;
    }
    return false;
}

}  // namespace helio::test
