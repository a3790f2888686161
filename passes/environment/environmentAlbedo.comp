// Directional albedos of microfacets and what they leave to the diffuse part, by roughness and the viewer's cosine.
// uSpecular: integrals of the GGX lobe times 1 - w and times w, w = (1 - wo.h)^5, so that a lobe with Schlick's
// reflectance has the albedo f0 x + f90 y; and the mean over cosine-weighted light of what the diffuse part loses of
// f90 - f0 (gltfDiffuseShare).
#version 460
#extension GL_GOOGLE_include_directive : require
const bool HAS_DIELECTRIC = true, HAS_TRANSMISSION = false, HAS_CLEARCOAT = false, HAS_SHEEN = false,
           HAS_IRIDESCENCE = false;
float sheenAlbedo(float cosine, float roughness) { return 0.0; }
#include "shaders/scattering/gltf.glsl"
#include "shaders/scene/specular_environment.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, rgba32f) uniform writeonly imageBuffer uSpecular;

const int ROOT = 32;  // of the number of directions

void main() {
    int node = int(gl_GlobalInvocationID.x), nodes = DIRECTIONAL_ALBEDO_NODES;
    if (node >= nodes * nodes) return;
    float x = float(node % nodes) / float(nodes - 1), roughness = float(node / nodes) / float(nodes - 1);
    float cosine = max(x * x, 1e-4), alpha = max(roughness * roughness, 1e-3);
    vec3 wo = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < ROOT * ROOT; ++k) {
        vec2 u = (vec2(k % ROOT, k / ROOT) + 0.5) / float(ROOT);
        vec3 h = ggxSampleNormal(wo, vec2(alpha), u), wi = reflectedAbout(wo, h), unused;
        ScatterValue v = ggxReflection(wo, wi, vec2(alpha), unused);
        float weight = v.density > 0.0 ? v.value.x / v.density : 0.0;
        float f = schlickWeight(clamp(dot(wo, h), 0.0, 1.0));
        sum.xy += weight * vec2(1.0 - f, f);
        vec3 from = cosineHemisphere(u);
        float half_ = clamp(dot(wo, normalizeSafe(wo + from, vec3(0.0, 0.0, 1.0))), 0.0, 1.0);
        sum.z += max(schlickWeight(half_), gltfGrazing(min(wo.z, from.z), alpha));
    }
    imageStore(uSpecular, node, vec4(sum / float(ROOT * ROOT), 0.0));
}
