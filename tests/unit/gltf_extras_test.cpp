#include "tests/unit/gltf_support.hpp"

namespace helio::test {
namespace {

/** The installed schema. */
json schema() {
    std::ifstream in(HELIOGRAPH_EXTRAS_SCHEMA);
    return json::parse(in);
}

class GltfExtras : public Gltf {
protected:
    Scene withScattering(const json& scattering) const {
        GltfDocument file = GltfDocument::triangle();
        file.primitive()["material"] = 0;
        file.doc["materials"] = {{{"extras", {{"heliograph", {{"scattering", scattering}}}}}}};
        return load(file);
    }
};

TEST_F(GltfExtras, MaterialsTakeEveryScatteringModel) {
    using Model = Scattering::Model;
    const std::pair<const char*, Model> models[] = {
        {"orenNayar", Model::OrenNayar},   {"mirror", Model::Mirror},
        {"dielectric", Model::Dielectric}, {"thinDielectric", Model::ThinDielectric},
        {"conductor", Model::Conductor},   {"phong", Model::Phong},
        {"blinnPhong", Model::BlinnPhong}};
    std::vector<std::string> names;
    for (const auto& [name, model] : models) {
        const Scene scene = withScattering({{"model", name}});
        ASSERT_TRUE(scene.materials[0].scattering.has_value());
        EXPECT_EQ(scene.materials[0].scattering->model, model);
        EXPECT_NO_THROW(scene.validate());
        EXPECT_TRUE(scene.skipped.empty());
        names.push_back(name);
    }
    EXPECT_EQ(schema()["definitions"]["scattering"]["properties"]["model"]["enum"], names)
        << "the schema and this list";
}

TEST_F(GltfExtras, MaterialsTakeTheModelsParameters) {
    const Scattering s = *withScattering({{"model", "conductor"},
                                          {"roughness", 0.5},
                                          {"alpha", {0.25, 0.5}},
                                          {"facets", "beckmann"},
                                          {"fresnel", "schlick"},
                                          {"n", {0.2, 0.9, 1.1}},
                                          {"k", {3.9, 2.5, 2.3}},
                                          {"exponent", 50}})
                              .materials[0]
                              .scattering;
    EXPECT_EQ(s.roughness, 0.5f);
    EXPECT_EQ(s.alpha, glm::vec2(0.25f, 0.5f));
    EXPECT_TRUE(s.beckmann);
    EXPECT_TRUE(s.schlick);
    EXPECT_EQ(s.n, glm::vec3(0.2f, 0.9f, 1.1f));
    EXPECT_EQ(s.k, glm::vec3(3.9f, 2.5f, 2.3f));
    EXPECT_EQ(s.exponent, 50);
    EXPECT_TRUE(withScattering({{"model", "conductor"}, {"multipleScattering", true}})
                    .materials[0]
                    .scattering->multipleScattering);
}

/** Every property of the schema has an example, which the loader takes. */
TEST_F(GltfExtras, ExamplesOfTheSchemaLoad) {
    const json whole = schema();
    const json& properties = whole["definitions"]["scattering"]["properties"];
    for (const auto& [name, property] : properties.items()) {
        if (name == "model") continue;
        ASSERT_TRUE(property.contains("examples")) << name;
        EXPECT_NO_THROW(withScattering({{"model", "dielectric"}, {name, property["examples"][0]}})) << name;
    }
}

TEST_F(GltfExtras, NodesHoldMeters) {
    const auto withMeter = [this](const json& meter) {
        GltfDocument file = GltfDocument::triangle();
        file.doc["nodes"][0]["name"] = "cell";
        file.doc["nodes"][0]["extras"] = {{"heliograph", {{"meter", meter}}}};
        const Scene scene = load(file);
        EXPECT_NO_THROW(scene.validate());
        EXPECT_EQ(scene.placedMeters().size(), 1u);
        return scene.meters.at(0);
    };
    std::vector<std::string> names;
    for (const auto& [name, quantity] : {std::pair{"irradiance", Meter::Quantity::Irradiance},
                                         {"flux", Meter::Quantity::Flux},
                                         {"radiance", Meter::Quantity::Radiance},
                                         {"intensity", Meter::Quantity::Intensity}}) {
        EXPECT_EQ(withMeter({{"quantity", name}}).quantity, quantity);
        names.emplace_back(name);
    }
    EXPECT_EQ(schema()["definitions"]["meter"]["properties"]["quantity"]["enum"], names);
    const Meter meter = withMeter(schema()["definitions"]["node"]["properties"]["meter"]["examples"][0]);
    EXPECT_EQ(meter.name, "cell");
    EXPECT_EQ(meter.width, 0.5f);
    EXPECT_EQ(meter.height, 0.25f);
    EXPECT_THROW(withMeter({{"quantity", "irradiance"}, {"width", 1}}), InputError);
    EXPECT_THROW(withMeter({{"quantity", "flux"}, {"width", 0}}), InputError);
    EXPECT_THROW(withMeter({{"quantity", "colour"}}), InputError);
}

TEST_F(GltfExtras, NodesTakeShapes) {
    const auto withShape = [this](const json& shape) {
        GltfDocument file = GltfDocument::triangle();
        file.doc["materials"] = {json::object(), {{"name", "second"}}};
        file.doc["nodes"].push_back({{"name", "ball"}, {"extras", {{"heliograph", {{"shape", shape}}}}}});
        file.doc["scenes"][0]["nodes"].push_back(int(file.doc["nodes"].size()) - 1);
        const Scene scene = load(file);
        EXPECT_NO_THROW(scene.validate());
        EXPECT_EQ(scene.triangleCount(), 1u);
        EXPECT_EQ(scene.shapeCount(), 1u);
        return scene;
    };
    const auto shapeOf = [](const Scene& scene) {
        return scene.meshes.at(std::size_t(scene.nodes.back().mesh)).primitives.at(0);
    };
    using Kind = Shape::Kind;
    const std::pair<const char*, Kind> kinds[] = {{"sphere", Kind::Sphere},
                                                  {"plane", Kind::Plane},
                                                  {"disc", Kind::Disc},
                                                  {"quad", Kind::Quad},
                                                  {"torus", Kind::Torus}};
    std::vector<std::string> names;
    for (const auto& [name, kind] : kinds) {
        EXPECT_EQ(shapeOf(withShape({{"kind", name}})).shape, Shape{.kind = kind});
        names.push_back(name);
    }
    EXPECT_EQ(schema()["definitions"]["shape"]["properties"]["kind"]["enum"], names);
    const Scene ball = withShape({{"kind", "sphere"}, {"radius", 2.5}, {"material", 1}});
    EXPECT_EQ(shapeOf(ball).shape->radius, 2.5f);
    EXPECT_EQ(shapeOf(ball).material, 1);
    EXPECT_EQ(ball.meshes.back().name, "ball");
    EXPECT_EQ(ball.bounds().lower, glm::dvec3(-2.5));
    const Scene flat = withShape({{"kind", "quad"}, {"width", 4}, {"height", 0.5}});
    EXPECT_EQ(shapeOf(flat).shape->width, 4.0f);
    EXPECT_EQ(shapeOf(flat).shape->height, 0.5f);
    EXPECT_EQ(shapeOf(flat).material, -1);
    for (const json& bad :
         {json{{"kind", "cone"}}, json{{"radius", 1}}, json{{"kind", "quad"}, {"radius", 1}},
          json{{"kind", "sphere"}, {"width", 1}}, json{{"kind", "plane"}, {"height", 1}},
          json{{"kind", "torus"}, {"tubeRadius", 1}}, json{{"kind", "disc"}, {"tubeRadius", 1}},
          json{{"kind", "sphere"}, {"radius", 0}}, json{{"kind", "disc"}, {"material", 2}}})
        EXPECT_THROW(withShape(bad), InputError) << bad.dump();
    GltfDocument both = GltfDocument::triangle();
    both.doc["nodes"][0]["extras"] = {{"heliograph", {{"shape", {{"kind", "sphere"}}}}}};
    EXPECT_THROW(load(both), InputError);
}

TEST_F(GltfExtras, MaterialsTakeASolidTexture) {
    using Pattern = SolidTexture::Pattern;
    const std::pair<const char*, Pattern> patterns[] = {{"noise", Pattern::Noise},
                                                        {"clouds", Pattern::Clouds},
                                                        {"marble", Pattern::Marble},
                                                        {"wood", Pattern::Wood}};
    std::vector<std::string> names;
    for (const auto& [name, pattern] : patterns) {
        GltfDocument file = GltfDocument::triangle();
        file.doc["materials"][0]["extras"]["heliograph"]["solid"] = {
            {"pattern", name}, {"first", {0.1, 0.2, 0.3}}, {"second", {0.4, 0.5, 0.6}}, {"scale", 7}};
        file.doc["meshes"][0]["primitives"][0]["material"] = 0;
        const Scene scene = load(file);
        EXPECT_NO_THROW(scene.validate());
        ASSERT_TRUE(scene.materials[0].solid.has_value());
        EXPECT_EQ(scene.materials[0].solid->pattern, pattern);
        EXPECT_EQ(scene.materials[0].solid->first, glm::vec3(0.1f, 0.2f, 0.3f));
        EXPECT_EQ(scene.materials[0].solid->second, glm::vec3(0.4f, 0.5f, 0.6f));
        EXPECT_EQ(scene.materials[0].solid->scale, 7);
        names.push_back(name);
    }
    const json whole = schema();
    EXPECT_EQ(whole["definitions"]["material"]["properties"]["solid"]["properties"]["pattern"]["enum"],
              names);
}

TEST_F(GltfExtras, MaterialsNameMapsOfHeightsAndLight) {
    const json properties = schema()["definitions"]["material"]["properties"];
    GltfDocument file = GltfDocument::triangle();
    file.doc["images"] = {{{"uri",
                            "data:image/png;base64,"
                            "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAA"
                            "AABJRU5ErkJggg=="}}};
    file.doc["textures"] = {{{"source", 0}}};
    file.doc["meshes"][0]["primitives"][0]["material"] = 0;
    json& own = file.doc["materials"][0]["extras"]["heliograph"];
    own["height"] = properties["height"]["examples"][0];
    own["lightmap"] = properties["lightmap"]["examples"][0];
    const Scene scene = load(file);
    EXPECT_NO_THROW(scene.validate());
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.heightTexture.texture, 0);
    EXPECT_EQ(material.heightTexture.texcoord, 0);
    EXPECT_EQ(material.heightScale, 0.1f);
    EXPECT_EQ(material.lightmapTexture.texture, 0);
    EXPECT_EQ(material.lightmapTexture.texcoord, 1);
    for (const auto& [name, bad] : {std::pair<const char*, json>{"height", {{"index", 1}}},
                                    {"height", {{"scale", 1}}},
                                    {"height", {{"index", 0}, {"texCoord", -1}}},
                                    {"lightmap", {{"index", 7}}},
                                    {"lightmap", {{"index", 0}, {"scale", 1}}}}) {
        GltfDocument wrong = file;
        wrong.doc["materials"][0]["extras"]["heliograph"][name] = bad;
        EXPECT_THROW(load(wrong), InputError) << bad.dump();
    }
}

class GltfCameraExtras : public GltfExtras {
protected:
    Camera withCamera(const json& own, const std::string& type = "perspective") const {
        GltfDocument file = GltfDocument::triangle();
        json camera = {{"type", type}, {"extras", {{"heliograph", own}}}};
        if (type == "perspective") camera["perspective"] = {{"yfov", 0.5}, {"znear", 0.1}};
        if (type != "perspective")
            camera["orthographic"] = {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 10}};
        file.doc["cameras"] = {camera};
        const Scene scene = load(file);
        EXPECT_NO_THROW(scene.validate());
        return scene.cameras.at(0);
    }
};

TEST_F(GltfCameraExtras, CamerasTakeAProjectionALensAndAnExposure) {
    const std::pair<const char*, Projection> projections[] = {{"plane", Projection::Plane},
                                                              {"latLong", Projection::LatLong},
                                                              {"equidistant", Projection::Equidistant},
                                                              {"equisolid", Projection::Equisolid}};
    std::vector<std::string> names;
    for (const auto& [name, projection] : projections) {
        const bool isFisheye = projection == Projection::Equidistant || projection == Projection::Equisolid;
        json look = {{"projection", name}};
        if (isFisheye) look["fieldOfView"] = 2.5;
        const Camera camera = withCamera(look);
        EXPECT_EQ(camera.projection, projection);
        EXPECT_EQ(camera.fieldOfView, isFisheye ? 2.5f : Camera{}.fieldOfView);
        EXPECT_FALSE(camera.lens || camera.exposure);
        names.push_back(name);
    }
    EXPECT_EQ(schema()["definitions"]["camera"]["properties"]["projection"]["enum"], names);
    const Camera camera = withCamera(
        {{"lens",
          {{"apertureDiameter", 0.02}, {"focusDistance", 1.5}, {"blades", 7}, {"bladeRotation", 0.25}}},
         {"exposure", {{"fNumber", 8}, {"shutter", 0.5}, {"iso", 200}}}});
    EXPECT_EQ(camera.lens, (ThinLens{0.02f, 1.5f, 7, 0.25f}));
    EXPECT_EQ(camera.exposure, (Exposure{8, 0.5f, 200}));
    // f/2 before 24 mm: the image lies 12 mm / tan(yfov / 2) behind the lens when 1.5 m are in focus.
    const double image = 0.012 / std::tan(0.25), focal = 1 / (1 / image + 1 / 1.5);
    EXPECT_NEAR(withCamera({{"lens", {{"fNumber", 2}, {"focusDistance", 1.5}}}}).lens->apertureDiameter,
                focal / 2, 1e-7);
    EXPECT_NEAR(withCamera({{"lens", {{"fNumber", 2}}}}).lens->apertureDiameter, image / 2, 1e-7);
}

TEST_F(GltfCameraExtras, WhatDoesNotGoTogetherIsRefused) {
    EXPECT_THROW(withCamera({{"lens", {{"focusDistance", 2}}}}), InputError);
    EXPECT_THROW(withCamera({{"lens", {{"fNumber", 2}, {"apertureDiameter", 1}}}}), InputError);
    EXPECT_THROW(withCamera({{"lens", {{"fNumber", 2}, {"blades", 2}}}}), InputError);
    EXPECT_THROW(withCamera({{"lens", {{"fNumber", 0}}}}), InputError);
    EXPECT_THROW(withCamera({{"lens", {{"fNumber", 2}}}, {"projection", "latLong"}}), InputError);
    EXPECT_THROW(withCamera({{"lens", {{"fNumber", 2}}}}, "orthographic"), InputError);
    EXPECT_THROW(withCamera({{"projection", "sphere"}}), InputError);
    EXPECT_THROW(withCamera({{"projection", "equisolid"}, {"fieldOfView", 7}}), InputError);
    EXPECT_THROW(withCamera({{"fieldOfView", 2}}), InputError);
    EXPECT_THROW(withCamera({{"lens", {{"apertureDiameter", 1}, {"sensorHeight", 1}}}}), InputError);
    EXPECT_THROW(withCamera({{"lens", {{"fNumber", 2}, {"bladeRotation", 1}}}}), InputError);
    EXPECT_THROW(withCamera({{"exposure", {{"iso", 0}}}}), InputError);
}

/** Every property of a camera has an example, which the loader takes. */
TEST_F(GltfCameraExtras, ExamplesOfTheSchemaLoad) {
    const json whole = schema();
    for (const auto& [name, property] : whole["definitions"]["camera"]["properties"].items()) {
        ASSERT_TRUE(property.contains("examples")) << name;
        json look = {{name, property["examples"][0]}};
        if (name == "fieldOfView") look["projection"] = "equidistant";
        EXPECT_NO_THROW(withCamera(look)) << name;
    }
}

TEST_F(GltfExtras, ScenesTakeAnEnvironment) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["scenes"][0]["extras"]["heliograph"]["environment"] = {{"radiance", {1, 0.5, 0.25}}};
    const Scene scene = load(file);
    ASSERT_TRUE(scene.environment.has_value());
    EXPECT_EQ(scene.environment->radiance, glm::vec3(1, 0.5f, 0.25f));
    ImageF sky;
    sky.width = 2, sky.height = 1;
    sky.channels = {"R", "G", "B"};
    sky.data = {1, 2, 3, 4, 5, 6};
    saveImage(folder_ / "sky.exr", sky);
    json& environment = file.doc["scenes"][0]["extras"]["heliograph"]["environment"];
    environment = {{"image", "sky.exr"}, {"rotation", {0, 0.6, 0, 0.8}}};
    const Scene shining = load(file);
    EXPECT_NO_THROW(shining.validate());
    EXPECT_EQ(shining.environment->radiance, glm::vec3(1));
    EXPECT_FLOAT_EQ(shining.environment->rotation.y, 0.6f);
    ASSERT_EQ(shining.images.size(), 1u);
    EXPECT_EQ(std::get<std::vector<float>>(shining.images[0].texels).at(4), 4);
    for (const char* path : {"../sky.exr", "/etc/passwd", "none.exr"}) {
        environment["image"] = path;
        EXPECT_THROW(load(file), InputError) << path;
    }
    environment = {{"radiance", {1, 0.5, 0.25}}};
    // Only the shown scene's counts.
    file.doc["scenes"].push_back({{"nodes", {0}}});
    file.doc["scene"] = 1;
    EXPECT_FALSE(load(file).environment.has_value());
}

TEST_F(GltfExtras, OthersExtrasAreNoConcern) {
    GltfDocument file = GltfDocument::triangle();
    file.doc["extras"] = 3;
    file.doc["nodes"][0]["extras"] = "text";
    file.doc["materials"] = {{{"extras", {{"other", {{"scattering", 7}}}}}}};
    EXPECT_NO_THROW(load(file));
}

TEST_F(GltfExtras, FaultsAreNamedWithPointerFaultAndRemedy) {
    struct Case {
        const char* pointer;  ///< of what is set
        json value;
        const char* place;
        const char* fault;
        const char* remedy;
    };
    const Case cases[] = {
        {"/materials/0/extras/heliograph", 3, "/materials/0/extras/heliograph", "type",
         "a material: scattering"},
        {"/materials/0/extras/heliograph/scatering", json::object(), "/materials/0/extras/heliograph",
         "scatering", "a material: scattering"},
        {"/materials/0/extras/heliograph/scattering/roughness", 0.5,
         "/materials/0/extras/heliograph/scattering", "model", "an object with model"},
        {"/materials/0/extras/heliograph/scattering/model", "lambert",
         "/materials/0/extras/heliograph/scattering/model", "", "one of orenNayar"},
        {"/materials/0/extras/heliograph/scattering",
         {{"model", "phong"}, {"exponent", -1}},
         "/materials/0/extras/heliograph/scattering/exponent",
         "",
         "a number from 0 to 1000000"},
        {"/materials/0/extras/heliograph/scattering",
         {{"model", "conductor"}, {"n", {1, 2}}},
         "/materials/0/extras/heliograph/scattering/n",
         "",
         "three numbers"},
        {"/materials/0/extras/heliograph/scattering",
         {{"model", "conductor"}, {"n", {1, "x", 2}}},
         "/materials/0/extras/heliograph/scattering/n/1",
         "type",
         "three numbers"},
        {"/scenes/0/extras/heliograph/environment/radiance",
         {1, -1, 0},
         "/scenes/0/extras/heliograph/environment/radiance/1",
         "",
         "three numbers, red, green and blue"},
        {"/nodes/0/extras/heliograph/meter",
         {{"quantity", "colour"}},
         "/nodes/0/extras/heliograph/meter/quantity",
         "",
         "one of irradiance"},
        {"/meshes/0/extras/heliograph", json::object(), "/meshes/0/extras/heliograph", "a mesh",
         "leave it out"},
        {"/extras/heliograph", json::object(), "/extras/heliograph", "an asset", "leave it out"},
    };
    for (const Case& fault : cases) {
        GltfDocument file = GltfDocument::triangle();
        file.doc["materials"] = {{{"name", "m"}}};
        file.doc[json::json_pointer(fault.pointer)] = fault.value;
        try {
            load(file);
            ADD_FAILURE() << fault.pointer << " was accepted";
        } catch (const InputError& error) {
            EXPECT_EQ(error.place, fault.place) << error.what();
            EXPECT_NE(error.fault.find(fault.fault), std::string::npos) << error.what();
            EXPECT_NE(error.remedy.find(fault.remedy), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace helio::test
