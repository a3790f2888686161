// Texels of normal maps as levels average them.
#ifndef PASSES_MIP_NORMAL_TEXELS_GLSL
#define PASSES_MIP_NORMAL_TEXELS_GLSL

/// The texel of the unit vector along a normal map's 2 v - 1: coarse or unnormalized texels all weigh 1 in a level's
/// means, whose lengths then say how much the normals vary (Toksvig, "Mipmapping normal maps", 2005). A texel without
/// a direction stays.
vec4 unitNormalTexel(vec4 texel) {
    vec3 n = texel.xyz * 2.0 - 1.0;
    float squared = dot(n, n);
    return squared > 1e-20 ? vec4(0.5 * n * (1.0 / sqrt(squared)) + 0.5, texel.w) : texel;
}

#endif
