// A struct of kernels and C++: the same text is both. std430 puts a scalar into a Vec3's fourth word.
struct Spot {
    Vec3 position;
    Real power;
    Vec3 direction;
    uint id;
    Vec4 color;
    Mat4 toWorld;
    Real falloff[4];
};
