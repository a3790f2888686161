#include "tests/unit/mesh/support.hpp"

#include <heliograph/image.hpp>

#include <cmath>

namespace helio::test {
namespace {

class Mtl : public MeshFile {
protected:
    Scene sceneWith(const std::string& lines) const {
        write("m.mtl", "newmtl m\n" + lines);
        return load("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl m\nf 1 2 3\n");
    }
    Material material(const std::string& lines) const { return sceneWith(lines).materials.at(0); }
    /** A PNG of one colour. */
    void writeImage(const std::string& name, float value) const {
        ImageF image;
        image.width = image.height = 2;
        image.channels = {"R", "G", "B"};
        image.data.assign(12, value);
        saveImage(folder_ / name, image);
    }
};

TEST_F(Mtl, DiffuseAndEmission) {
    const Material material = this->material("Kd 0.1 0.2 0.3\nKe 5\nillum 1\nKs 1 1 1\n");
    EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 1));
    EXPECT_EQ(material.emission, glm::vec3(5)) << "one number is grey";
    EXPECT_EQ(material.metallic, 0);
    EXPECT_EQ(material.specular, 0) << "illum 1 has no highlight";
    EXPECT_EQ(this->material("Ns 1\n").baseColor, glm::vec4(0.8f, 0.8f, 0.8f, 1));
}

TEST_F(Mtl, PhongLobeKeepsReflectanceAndWidth) {
    const Material material = this->material("Kd 0.1 0.1 0.1\nKs 0.2 0.1 0.05\nNs 30\nNi 2\nillum 2\n");
    const float f0 = 1.0f / 9;  // ((2 - 1) / (2 + 1))^2
    EXPECT_NEAR(material.specularColor.x * f0, 0.2, 1e-6);
    EXPECT_NEAR(material.specularColor.z * f0, 0.05, 1e-6);
    EXPECT_NEAR(std::pow(double(material.roughness), 4), 2.0 / 32, 1e-6);
    EXPECT_EQ(material.ior, 2);
}

TEST_F(Mtl, MirrorsAndGlass) {
    const Material mirror = material("Kd 0 0 0\nKs 0.9 0.8 0.7\nNs 1000\nillum 5\n");
    EXPECT_EQ(mirror.metallic, 1);
    EXPECT_EQ(mirror.roughness, 0);
    EXPECT_EQ(mirror.baseColor, glm::vec4(0.9f, 0.8f, 0.7f, 1));
    const Material glass = material("Kd 0.01 0.01 0.01\nKs 0.3 0.3 0.3\nTf 0.9 1 0.9\nNi 1.33\nillum 7\n");
    EXPECT_EQ(glass.transmission, 1);
    EXPECT_GT(glass.thickness, 0);
    EXPECT_EQ(glass.ior, 1.33f);
    EXPECT_EQ(glass.baseColor, glm::vec4(0.9f, 1, 0.9f, 1));
    EXPECT_EQ(material("illum 7\n").baseColor, glm::vec4(1)) << "without Tf nothing is filtered";
}

TEST_F(Mtl, PhysicalExtension) {
    const Material material =
        this->material("Kd 1 1 1\nPr 0.25\nPm 0.75\nPc 0.5\nPcr 0.1\naniso 0.2\nanisor 0.25\n");
    EXPECT_EQ(material.roughness, 0.25f);
    EXPECT_EQ(material.metallic, 0.75f);
    EXPECT_EQ(material.clearcoat, 0.5f);
    EXPECT_EQ(material.clearcoatRoughness, 0.1f);
    EXPECT_EQ(material.anisotropyStrength, 0.2f);
    EXPECT_NEAR(material.anisotropyRotation, 1.5707963, 1e-6);
}

TEST_F(Mtl, Opacity) {
    EXPECT_EQ(material("d 0.25\n").baseColor.a, 0.25f);
    EXPECT_EQ(material("Tr 0.25\n").baseColor.a, 0.75f);
    EXPECT_EQ(material("d 0.5\nTr 0.25\n").alphaMode, AlphaMode::Blend);
    EXPECT_EQ(material("d 1\n").alphaMode, AlphaMode::Opaque);
}

TEST_F(Mtl, Textures) {
    fs::create_directories(folder_ / "tex");
    writeImage("tex/a b.png", 1);
    writeImage("c.png", 0.5);
    const Scene scene =
        sceneWith("map_Kd -s 2 4 -o 0.5 0.25 -clamp on tex\\a b.png\nmap_Ke c.png\nmap_bump c.png\n");
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.baseColor, glm::vec4(1));
    EXPECT_EQ(material.emission, glm::vec3(1));
    ASSERT_EQ(scene.textures.size(), 2u);
    EXPECT_EQ(scene.images.size(), 2u);
    EXPECT_EQ(scene.textures[std::size_t(material.baseColorTexture.texture)].wrapU, Wrap::ClampToEdge);
    // (u, v) with v up goes to (2 u + 0.5, 4 v + 0.25) with v up.
    const float u = 0.3f, v = 0.7f;
    const glm::vec3 at = material.baseColorTexture.transform * glm::vec3(u, 1 - v, 1);
    EXPECT_NEAR(at.x, 2 * u + 0.5, 1e-6);
    EXPECT_NEAR(1 - at.y, 4 * v + 0.25, 1e-6);
    ASSERT_EQ(scene.skipped.size(), 1u);
    EXPECT_EQ(scene.skipped[0].first, "MTL bump");
}

TEST_F(Mtl, BumpIsAMapOfHeightsWhereItSaysHowHigh) {
    writeImage("h.png", 0.5);
    const Scene scene = sceneWith("Kd 1 1 1\nbump -bm 0.25 h.png\n");
    const Material& material = scene.materials.at(0);
    EXPECT_TRUE(material.heightTexture);
    EXPECT_EQ(material.heightScale, 0.25f);
    EXPECT_TRUE(scene.skipped.empty());
}

TEST_F(Mtl, LinksOutOfTheFolderWarn) {
    fs::create_directory(folder_ / "inside");
    write("secret.png", "");
    write("secret.mtl", "newmtl a\nKd 1 0 0\n");
    for (const char* name : {"map.png", "other.mtl"})
        fs::create_symlink(std::string("../secret") + fs::path(name).extension().string(),
                           folder_ / "inside" / name);
    write("inside/scene.mtl", "newmtl b\nmap_Kd map.png\n");
    const Scene scene = load("inside/scene.obj",
                             "mtllib other.mtl\nmtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                             "usemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1/1 2/1 3/1\n");
    EXPECT_TRUE(mentions(scene.warnings, "'other.mtl' leads out of the scene's folder by a symbolic link"));
    EXPECT_TRUE(mentions(scene.warnings, "'map.png' leads out of the scene's folder by a symbolic link"));
}

TEST_F(Mtl, TexturesThatAreNotThereWarn) {
    write("no.png", "not an image");
    const Scene scene =
        sceneWith("map_Kd missing.png\nmap_Ke ../out.png\nnorm /etc/hostname\nmap_Ks no.png\nKs 1 1 1\n");
    EXPECT_TRUE(mentions(scene.warnings, "'missing.png' does not exist"));
    EXPECT_TRUE(mentions(scene.warnings, "'../out.png' leads out"));
    EXPECT_TRUE(mentions(scene.warnings, "'/etc/hostname' leads out"));
    EXPECT_TRUE(mentions(scene.warnings, "'no.png' is neither PNG nor JPEG"));
}

}  // namespace
}  // namespace helio::test
