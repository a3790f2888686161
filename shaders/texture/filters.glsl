// Texture filters over a pixel's footprint, all in full floats: nearest, bilinear, two bicubics, trilinear, anisotropic,
// the elliptical weighted average and ripmaps.
#ifndef SHADERS_TEXTURE_FILTERS_GLSL
#define SHADERS_TEXTURE_FILTERS_GLSL

#include "shaders/texture/trilinear.glsl"

layout(constant_id = 127) const int TEXTURE_FILTER = 4;  ///< FILTER_*: the order of helio::TextureFilter
const int FILTER_NEAREST = 0, FILTER_BILINEAR = 1, FILTER_CATMULL_ROM = 2, FILTER_BSPLINE = 3, FILTER_TRILINEAR = 4,
          FILTER_ANISOTROPIC = 5, FILTER_EWA = 6, FILTER_RIPMAP = 7;

/// (u, v) in texels of a level, even repeats taken out first, which keeps the fraction's bits.
vec2 texelPosition(uvec4 header, ivec2 size, vec2 uv) {
    uint wrapU = header.w & 3u, wrapV = header.w >> 2 & 3u;
    vec2 position = clamp(uv, -1048576.0, 1048576.0);
    vec2 whole = floor(position * 0.5) * 2.0;
    vec2 base = vec2(wrapU == 2u ? position.x : position.x - whole.x, wrapV == 2u ? position.y : position.y - whole.y);
    return clamp(base, -4.0, 4.0) * vec2(size);
}

/// A texel of a level, wrapped. `offset` is the level's place in uMips, negative for the base.
vec4 wrappedTexel(uvec4 header, int offset, ivec2 size, ivec2 at) {
    int x = wrapIndex(at.x, size.x, header.w & 3u), y = wrapIndex(at.y, size.y, header.w >> 2 & 3u);
    vec4 value = vec4(0.0);
    if (offset < 0) value = fetchTexel(header, x, y);
    else value = texelFetch(uMips, offset + y * size.x + x);
    return value;
}

/// Texel floor(u W), floor(v H).
vec4 sampleNearest(int texture, vec2 uv) {
    uvec4 header = texelFetch(uTextures, texture);
    ivec2 size = ivec2(header.yz);
    return wrappedTexel(header, -1, size, ivec2(floor(texelPosition(header, size, uv))));
}

/// Weights of the four texels about a fraction f: the spline of Catmull and Rom (1974), through the texels and right for
/// quadratics; or the cubic B-spline, which smooths and is right for lines.
vec4 cubicWeights(float f, bool bspline) {
    float g = 1.0 - f;
    vec4 b = vec4(g * g * g, 4.0 - 3.0 * f * f * (2.0 - f), 4.0 - 3.0 * g * g * (2.0 - g), f * f * f) * (1.0 / 6.0);
    vec4 c = vec4(f * (f * (1.0 - 0.5 * f) - 0.5), f * f * (1.5 * f - 2.5) + 1.0, f * (f * (2.0 - 1.5 * f) + 0.5),
                  f * f * (0.5 * f - 0.5));
    return bspline ? b : c;
}

vec4 sampleBicubic(int texture, vec2 uv, bool bspline) {
    uvec4 header = texelFetch(uTextures, texture);
    ivec2 size = ivec2(header.yz);
    vec2 texel = texelPosition(header, size, uv) - 0.5, corner = floor(texel);
    vec4 wx = cubicWeights(texel.x - corner.x, bspline), wy = cubicWeights(texel.y - corner.y, bspline);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 16; ++k) {
        int x = k & 3, y = k >> 2;
        sum += wx[x] * wy[y] * wrappedTexel(header, -1, size, ivec2(corner) + ivec2(x - 1, y - 1));
    }
    return sum;
}

/// Trilinear at a level of detail.
vec4 sampleLevel(uvec4 header, MipChain chain, vec2 uv, float level) {
    ivec2 size = ivec2(header.yz);
    int fine = int(level), coarse = min(fine + 1, chain.levels - 1);
    ivec3 a = fine == 0 ? ivec3(-1, size) : fetchMipLevel(chain, fine);
    ivec3 b = coarse == 0 ? ivec3(-1, size) : fetchMipLevel(chain, coarse);
    return mix(sampleMipLevel(header, a.x, a.yz, uv), sampleMipLevel(header, b.x, b.yz, uv), level - float(fine));
}

/// Axes of the ellipse that a disc of radius 1/2 about the pixel's centre covers, in texels: half the singular values of
/// the derivatives with the left singular vectors. `xx`, `xy`, `yy` are those of J J^T.
struct Footprint {
    vec2 major, minor;  // unit
    float longest, shortest;  // lengths of the axes
};

Footprint footprint(vec2 tx, vec2 ty) {
    float xx = tx.x * tx.x + ty.x * ty.x, xy = tx.x * tx.y + ty.x * ty.y, yy = tx.y * tx.y + ty.y * ty.y;
    float half_ = 0.5 * (xx - yy), root = sqrt(half_ * half_ + xy * xy), mean = 0.5 * (xx + yy);
    Footprint f;
    f.longest = sqrt(mean + root);
    // By the determinant: no difference of nearly equal numbers.
    f.shortest = f.longest > 0.0 ? abs(tx.x * ty.y - tx.y * ty.x) / f.longest : 0.0;
    vec2 axis = half_ >= 0.0 ? vec2(half_ + root, xy) : vec2(xy, root - half_);
    float l = length(axis);
    f.major = l > 0.0 ? axis / l : vec2(1.0, 0.0);
    f.minor = vec2(-f.major.y, f.major.x);
    return f;
}

/// Up to 16 trilinear samples along the footprint's longer axis, at the level of the shorter.
vec4 sampleAnisotropic(int texture, vec2 uv, vec2 dx, vec2 dy) {
    uvec4 header = texelFetch(uTextures, texture);
    vec2 size = vec2(header.yz);
    MipChain chain = fetchMipChain(texture);
    Footprint f = footprint(clamp(dx * size, -1e9, 1e9), clamp(dy * size, -1e9, 1e9));
    float taps = clamp(ceil(f.longest / max(f.shortest, 1e-6)), 1.0, 16.0);
    if (!(f.longest > 1.0)) taps = 1.0;
    float width = f.longest / taps;
    float level = clamp(width > 1.0 ? realLog2(width) : 0.0, 0.0, float(chain.levels - 1));
    vec2 along = f.major * f.longest / size;
    vec4 sum = vec4(0.0);
    for (float k = 0.0; k < taps; k += 1.0)
        sum += sampleLevel(header, chain, uv + along * ((k + 0.5) / taps - 0.5), level);
    return sum / taps;
}

// Variances of the pixel's box, in pixels, and of the tent between texels, in texels: the Gaussian has those of the
// bilinear texture's mean over the pixel.
const float EWA_PIXEL = 1.0 / 12.0, EWA_TEXEL = 1.0 / 6.0;
const float EWA_REACH = 3.5;  // standard deviations

/// Elliptical weighted average (Greene and Heckbert 1986): a Gaussian over the footprint, summed over the texels of the
/// level at which its shorter axis has one to two texels of standard deviation. Its covariance is J J^T/12 + 1/6;
/// what the level's own boxes of 2^L texels blur, (4^L - 1)/12, is taken off.
vec4 sampleEwa(int texture, vec2 uv, vec2 dx, vec2 dy) {
    uvec4 header = texelFetch(uTextures, texture);
    ivec2 baseSize = ivec2(header.yz);
    MipChain chain = fetchMipChain(texture);
    Footprint f = footprint(clamp(dx * vec2(baseSize), -1e6, 1e6), clamp(dy * vec2(baseSize), -1e6, 1e6));
    float major = f.longest * f.longest * EWA_PIXEL + EWA_TEXEL;
    // At most 16 times as long as wide.
    float minor = max(f.shortest * f.shortest * EWA_PIXEL + EWA_TEXEL, major / 256.0);
    float level = clamp(floor(0.5 * realLog2(minor)), 0.0, float(chain.levels - 1));
    float scale = realExp2(-2.0 * level), blurred = (1.0 - scale) / 12.0;
    // On the last level a Gaussian wider than the texture is the texture's mean.
    major = clamp(major * scale - blurred, 0.05, 4096.0);
    minor = clamp(minor * scale - blurred, 0.05, 4096.0);
    ivec3 place = level == 0.0 ? ivec3(-1, baseSize) : fetchMipLevel(chain, int(level));
    ivec2 size = place.yz;
    vec2 centre = texelPosition(header, size, uv) - 0.5;
    // Inverse covariance A = major^-1 m m^T + minor^-1 n n^T; q = d^T A d.
    float xx = f.major.x * f.major.x / major + f.minor.x * f.minor.x / minor;
    float xy = f.major.x * f.major.y / major + f.minor.x * f.minor.y / minor;
    float yy = f.major.y * f.major.y / major + f.minor.y * f.minor.y / minor;
    float high = EWA_REACH * sqrt(f.major.y * f.major.y * major + f.minor.y * f.minor.y * minor);
    int first = int(ceil(centre.y - high)), last = min(int(floor(centre.y + high)), first + 255);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int y = first; y <= last; ++y) {
        float dy_ = float(y) - centre.y;
        // The row's stretch of the ellipse q <= reach^2.
        float middle = -xy * dy_ / xx;
        float half_ = sqrt(max(EWA_REACH * EWA_REACH / xx - dy_ * dy_ * (yy - xy * xy / xx) / xx, 0.0));
        int begin = int(ceil(centre.x + middle - half_)), end = min(int(floor(centre.x + middle + half_)), begin + 127);
        for (int x = begin; x <= end; ++x) {
            float dx_ = float(x) - centre.x;
            float weight = realExp(-0.5 * (xx * dx_ * dx_ + 2.0 * xy * dx_ * dy_ + yy * dy_ * dy_));
            sum += weight * wrappedTexel(header, place.x, size, ivec2(x, y));
            weights += weight;
        }
    }
    return sum / max(weights, 1e-30);
}

/// Level (i, j) of a ripmap, bilinear. The base is at uMips's place -1.
vec4 sampleRipLevel(uvec4 header, uvec4 chain, ivec2 level, vec2 uv) {
    uvec4 place = texelFetch(uMipTable, int(chain.z) + level.y * int(chain.w) + level.x);
    bool isBase = level == ivec2(0);
    return sampleMipLevel(header, isBase ? -1 : int(place.x), isBase ? ivec2(header.yz) : ivec2(place.yz), uv);
}

/// Means over rectangles along the texture's axes, linear between levels: as wide and as high as the pixel's parallelogram
/// where that lies along the axes, else of the same variances.
vec4 sampleRipmap(int texture, vec2 uv, vec2 dx, vec2 dy) {
    uvec4 header = texelFetch(uTextures, texture), chain = texelFetch(uMipTable, texture);
    if (chain.w == 0u) return sampleTexture(texture, uv);
    vec2 size = vec2(header.yz), tx = clamp(dx * size, -1e9, 1e9), ty = clamp(dy * size, -1e9, 1e9);
    vec2 squared = tx * tx + ty * ty;
    vec2 last = vec2(ivec2(int(chain.w) - 1, findMSB(header.z)));
    vec2 level = min(vec2(squared.x > 1.0 ? 0.5 * realLog2(squared.x) : 0.0, squared.y > 1.0 ? 0.5 * realLog2(squared.y) : 0.0), last);
    if (level == vec2(0.0)) return sampleTexture(texture, uv);
    ivec2 fine = ivec2(level), coarse = min(fine + 1, ivec2(last));
    vec2 f = level - vec2(fine);
    vec4 a = sampleRipLevel(header, chain, fine, uv), b = sampleRipLevel(header, chain, ivec2(coarse.x, fine.y), uv);
    vec4 c = sampleRipLevel(header, chain, ivec2(fine.x, coarse.y), uv), d = sampleRipLevel(header, chain, coarse, uv);
    return mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
}

/// Linear colour at (u, v) whose derivatives over one pixel are dx and dy, by the filter that was chosen.
vec4 sampleFiltered(int texture, vec2 uv, vec2 dx, vec2 dy) {
    vec4 value = vec4(0.0);
    if (TEXTURE_FILTER == FILTER_NEAREST) value = sampleNearest(texture, uv);
    if (TEXTURE_FILTER == FILTER_BILINEAR) value = sampleTexture(texture, uv);
    if (TEXTURE_FILTER == FILTER_CATMULL_ROM) value = sampleBicubic(texture, uv, false);
    if (TEXTURE_FILTER == FILTER_BSPLINE) value = sampleBicubic(texture, uv, true);
    if (TEXTURE_FILTER == FILTER_TRILINEAR) value = sampleTrilinear(texture, uv, dx, dy);
    if (TEXTURE_FILTER == FILTER_ANISOTROPIC) value = sampleAnisotropic(texture, uv, dx, dy);
    if (TEXTURE_FILTER == FILTER_EWA) value = sampleEwa(texture, uv, dx, dy);
    if (TEXTURE_FILTER == FILTER_RIPMAP) value = sampleRipmap(texture, uv, dx, dy);
    return value;
}

#endif
