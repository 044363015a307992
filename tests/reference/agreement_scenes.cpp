#include "agreement_scenes.h"

#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

const dvec3 kEye(0.4, 0.6, 4.5), kMiddle(0, -0.1, 0);

Medium gridOf(const vec3& scattering, const vec3& absorption, double anisotropy, uint64_t seed,
              double densest = 4) {
    Medium medium;
    medium.kind = MediumKind::Grid;
    medium.scattering = scattering;
    medium.absorption = absorption;
    medium.anisotropy = float(anisotropy);
    medium.density = lumpyGrid(2.4, densest, seed);
    return medium;
}

void addFloor(SceneMaker& maker, const Material& material) {
    // Facing up: the plane lies in XZ of its node, whose -Z looks along the world's.
    dmat4 place(1.0);
    place[3].y = -1.3;
    maker.addPrimitive(PrimitiveShape::Plane, {8, 1, 8}, material, place);
}

void addRect(SceneMaker& maker, const vec3& radiance) {
    Light light;
    light.type = LightType::Rect;
    light.size = {6, 5};
    light.radiance = 0.4f * radiance;
    maker.addLight(light, lookAlong({-0.3, -1, -0.1}, {0.6, 2, 0.2}));
}

void addSky(SceneMaker& maker) {
    auto image = std::make_shared<Image>(8, 4, 3);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            const bool sun = y == 1 && x == 5;
            image->at(x, y)[0] = sun ? 5.0f : 0.3f;
            image->at(x, y)[1] = sun ? 4.0f : 0.2f + 0.05f * float(x);
            image->at(x, y)[2] = sun ? 3.0f : 0.2f + 0.2f * float(3 - y);
        }
    maker.scene().environment.image = image;
    maker.scene().environment.intensity = 0.8f;
    maker.scene().environment.rotation = 0.9f;
}

Material metal() {
    Material material;
    material.baseColor = {0.9f, 0.6f, 0.3f, 1};
    material.metallic = 1;
    material.roughness = 0.5f;
    material.doubleSided = true;
    return material;
}

/// A chequered leaf with holes.
Material leaf(SceneMaker& maker) {
    ImageData image;
    image.width = image.height = 8;
    for (int i = 0; i < 64; ++i) {
        const bool dark = (i + i / 8) % 2 == 0, hole = i % 8 >= 6;
        for (const int v : {dark ? 90 : 230, dark ? 200 : 120, 60, hole ? 0 : 255})
            image.rgba.push_back(uint8_t(v));
    }
    maker.scene().images.push_back(image);
    maker.scene().textures.push_back({0, {}});
    Material material = matt(vec3(0.9f));
    material.baseColorTexture.texture = 0;
    material.alphaMode = AlphaMode::Mask;
    return material;
}

void colouredSmoke(SceneMaker& maker) {
    maker.addMedium(gridOf({0.6f, 1.5f, 3}, {0.5f, 0.2f, 0.05f}, 0.95, 1));
    maker.addPointLight({-1.2, 1.6, -1.6}, 30, 1.4);
    addFloor(maker, matt({0.6f, 0.7f, 0.4f}));
}

void backwardBall(SceneMaker& maker) {
    Medium ball = matter(MediumKind::Sphere, 0.9, -0.95);
    ball.size = {2.4, 2, 2.2};
    ball.scattering *= vec3(0.8f, 1, 1.4f);
    maker.addMedium(ball, dvec3(0));
    addRect(maker, {5, 6, 7});
    addFloor(maker, matt({0.7f, 0.4f, 0.4f}));
}

void fire(SceneMaker& maker) {
    Medium flames = gridOf({0.4f, 0.6f, 0.2f}, {1.5f, 0.5f, 0.2f}, 0.2, 2);
    flames.emission = {3, 1.2f, 0.3f};
    maker.addMedium(flames);
    addFloor(maker, matt(vec3(0.8f)));
}

void underASky(SceneMaker& maker) {
    maker.addMedium(gridOf({2, 1.5f, 1}, {0.1f, 0.3f, 0.5f}, 0.7, 3));
    maker.addPrimitive(PrimitiveShape::Box, {0.7, 1.2, 0.7}, matt({0.4f, 0.6f, 0.9f}),
                       lookAlong({0.4, 0.3, 1}, {-0.4, -0.5, 0.3}));
    addSky(maker);
}

void insideFog(SceneMaker& maker) {
    Medium fog;
    fog.kind = MediumKind::Height;
    fog.scaleHeight = 1.2;
    fog.scattering = {0.25f, 0.3f, 0.4f};
    fog.absorption = {0.02f, 0.05f, 0.02f};
    fog.anisotropy = 0.6f;
    maker.addMedium(fog, dvec3(0, -0.5, 0));
    maker.addPointLight({-1.2, 0.6, 0}, 15, 0.7);
    addFloor(maker, matt({0.5f, 0.5f, 0.6f}));
    maker.scene().environment.radiance = {0.1f, 0.15f, 0.25f};
}

void overlapping(SceneMaker& maker) {
    maker.addMedium(gridOf({1, 0.8f, 0.6f}, {0.1f, 0.1f, 0.3f}, 0.7, 4));
    Medium rayleigh = matter(MediumKind::Box, 0.95, 0);
    rayleigh.size = {2, 1.6, 2};
    rayleigh.phase = PhaseFunction::Rayleigh;
    rayleigh.scattering *= vec3(0.2f, 0.5f, 1.1f);
    maker.addMedium(rayleigh, dvec3(0.3, 0.1, 0));
    Medium dust = matter(MediumKind::Sphere, 0.8, 0.6);
    dust.size = dvec3(1.8);
    dust.phase = PhaseFunction::CornetteShanks;
    maker.addMedium(dust, dvec3(-0.4, 0, 0.2));
    Light sun;
    sun.type = LightType::Directional;
    sun.intensity = 5;
    sun.radius = 0.5f;
    maker.addLight(sun, lookAlong({-0.4, -1, -0.5}));
    addFloor(maker, matt(vec3(0.5f)));
}

void mirrored(SceneMaker& maker) {
    dmat4 place = lookAlong({0.4, 0.2, 1}, {-0.2, 0.1, 0});
    place[0] *= -1.2;
    place[1] *= 0.7;
    maker.addMedium(gridOf({1.2f, 1.2f, 1.2f}, {0.1f, 0.4f, 0.2f}, -0.4, 5), place);
    Medium ball = matter(MediumKind::Sphere, 0.85, 0.5);
    ball.size = {1.6, 1, 1.2};
    maker.addMedium(ball, place);
    dmat4 box = lookAlong({0.7, -0.3, 1}, {0.7, -0.6, 0.6});
    box[2] *= -1.5;
    maker.addPrimitive(PrimitiveShape::Box, dvec3(0.6), matt({0.9f, 0.3f, 0.2f}), box);
    addRect(maker, vec3(6));
    addFloor(maker, matt(vec3(0.6f)));
}

void whiteCloud(SceneMaker& maker) {
    Medium cloud = gridOf(vec3(3), vec3(0), 0.8, 6, 5);
    maker.addMedium(cloud);
    maker.scene().environment.radiance = {0.5f, 0.8f, 1.2f};
    addFloor(maker, matt({0.6f, 0.3f, 0.1f}));
}

void leafInFog(SceneMaker& maker) {
    Medium fog = matter(MediumKind::Box, 0.9, 0.3);
    fog.size = {3, 2.6, 3};
    fog.scattering *= 0.5f;
    maker.addMedium(fog, dvec3(0));
    const Material material = leaf(maker);
    maker.addPrimitive(PrimitiveShape::Box, {1.2, 1.4, 1}, material,
                       lookAlong({0.5, 0.4, 1}, {0, -0.2, 0}));
    Material glass = matt({0.3f, 0.8f, 0.4f});
    glass.alphaMode = AlphaMode::Blend;
    glass.baseColor.w = 0.5f;
    maker.addPrimitive(PrimitiveShape::Box, {0.2, 1.4, 1}, glass,
                       lookAlong({-0.3, 0, 1}, {1.1, 0, 0.8}));
    addRect(maker, {7, 6, 4});
    addFloor(maker, matt(vec3(0.5f)));
}

void roughMetal(SceneMaker& maker) {
    maker.addMedium(gridOf(vec3(0.8f), vec3(0.1f, 0.2f, 0.3f), 0.5, 7, 3));
    maker.addPrimitive(PrimitiveShape::Box, dvec3(1), metal(),
                       lookAlong({0.4, 0.3, 1}, {0.5, -0.6, 0}));
    Material glowing = matt(vec3(0.3f));
    glowing.emissive = {4, 2, 1};
    maker.addPrimitive(PrimitiveShape::Box, {0.8, 0.8, 0.8}, glowing,
                       lookAlong({-0.2, 0.5, 1}, {-1, 0.5, 0}));
    Material coated = matt({0.2f, 0.4f, 0.7f});
    coated.specular = 1;
    coated.roughness = 0.6f;
    addFloor(maker, coated);
    addRect(maker, vec3(4));
}

} // namespace

AgreementScene agreementScene(int index) {
    struct Entry {
        const char* name;
        void (*make)(SceneMaker&);
        uint32_t simple, volume;
        dvec3 eye = kEye;
    };
    static const Entry entries[kAgreementScenes] = {
        {"coloured smoke, g 0.95, a ball of light", colouredSmoke, 2048, 256},
        {"an ellipsoid, g -0.95, a bright rectangle", backwardBall, 3072, 128},
        {"fire", fire, 384, 128},
        {"an uneven sky", underASky, 384, 128},
        {"an eye inside height fog", insideFog, 768, 128, {0.4, 0.1, 2.2}},
        {"three media over each other, three phase functions, a wide sun", overlapping, 768, 128},
        {"mirrored and squeezed", mirrored, 640, 128},
        {"a cloud without absorption", whiteCloud, 256, 96},
        {"leaves with holes, and panes of half coverage, in fog", leafInFog, 768, 128},
        {"rough metal, a coated floor, a glowing box", roughMetal, 640, 128},
    };
    const Entry& entry = entries[index];
    SceneMaker maker;
    entry.make(maker);
    AgreementScene result{
        entry.name, {}, maker.addCamera(entry.eye, kMiddle), entry.simple, entry.volume};
    result.scene = maker.take();
    return result;
}

} // namespace tyndall::validation
