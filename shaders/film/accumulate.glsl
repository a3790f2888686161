// Running mean and variance of a pixel that stay exact after millions of samples. Valid GLSL and C++.
//
// A dispatch gathers its few samples in registers (FilmBatch): plain sums of x - shift and (x - shift)^2, where
// the shift is the pixel's mean so far, so that nothing cancels. It is then merged once into the stored state
// (FilmPixel): sums per half in double-single (two floats, 48 bits), and the sum of squared deviations from the
// mean after Chan, Golub and LeVeque, "Updating Formulae and a Pairwise Algorithm for Computing Sample
// Variances" (1979), whose increments are all positive. No atomics: one invocation owns a pixel, and the order
// of its samples is fixed, so the same input gives the same bits.
//
// Halves A and B are the even and odd samples, see shaders/sampling/sampler.glsl.
#ifndef SHADERS_FILM_ACCUMULATE_GLSL
#define SHADERS_FILM_ACCUMULATE_GLSL
#include "shaders/shared/real.glsl"

/// What the film holds of one pixel. Values are hi + lo, |lo| <= ulp(hi) / 2. Counts are exact to 2^24.
struct FilmPixel {
    Vec3 sumA;
    Vec3 sumALow;
    Vec3 sumB;
    Vec3 sumBLow;
    Vec3 deviation;  // sum over all samples of (x - mean)^2
    Vec3 deviationLow;
    Real countA;
    Real countB;
    Real rejected;  // samples that were not finite and were left out
};

/// Samples gathered in registers; at most 4096 of them.
struct FilmBatch {
    Vec3 shift;
    Vec3 sumA;     // of x - shift
    Vec3 sumB;     // of x - shift
    Vec3 squares;  // of (x - shift)^2, both halves
    Real countA;
    Real countB;
    Real rejected;
    bool shifted;  // whether shift is set
};

/// a + b = sum + error without rounding (Knuth's TwoSum). The error is 0 where the sum is infinite.
FN void twoSum(Vec3 a, Vec3 b, OUT(Vec3) sum, OUT(Vec3) error) {
    precise Vec3 s = a + b;
    precise Vec3 t = s - a;
    precise Vec3 e = (a - (s - t)) + (b - t);
    sum = s;
    error = Vec3(isinf(s.x) ? Real(0.0) : e.x, isinf(s.y) ? Real(0.0) : e.y, isinf(s.z) ? Real(0.0) : e.z);
}

/// Adds b to the double-single hi + lo.
FN void addToDoubleSingle(INOUT(Vec3) hi, INOUT(Vec3) lo, Vec3 b) {
    Vec3 s;
    Vec3 e;
    twoSum(hi, b, s, e);
    twoSum(s, lo + e, hi, lo);
}

/// x = leading + trailing, where the leading part has 12 significant bits, so that both times an integer below
/// 4096 are exact (the trailing part has at most 12 as well).
FN Real filmLeadingBits(Real x) { return uintBitsToFloat(floatBitsToUint(float(x)) & 0xfffff000u); }
FN Vec3 filmLeadingBits(Vec3 v) { return Vec3(filmLeadingBits(v.x), filmLeadingBits(v.y), filmLeadingBits(v.z)); }

/// Adds count * value to hi + lo without rounding the product; count is an integer below 2^24.
FN void addProduct(INOUT(Vec3) hi, INOUT(Vec3) lo, Real count, Vec3 value) {
    Vec3 leading = filmLeadingBits(value);
    Vec3 trailing = value - leading;
    Real high = floor(count * REAL(0.000244140625)) * REAL(4096.0);
    Real low = count - high;
    addToDoubleSingle(hi, lo, leading * high);
    addToDoubleSingle(hi, lo, leading * low);
    addToDoubleSingle(hi, lo, trailing * high);
    addToDoubleSingle(hi, lo, trailing * low);
}

FN FilmPixel emptyFilmPixel() {
    Vec3 zero = Vec3(0.0);
    return FilmPixel(zero, zero, zero, zero, zero, zero, REAL(0.0), REAL(0.0), REAL(0.0));
}

FN Real filmCount(FilmPixel p) { return p.countA + p.countB; }

/// The mean of all samples, 0 where there are none.
FN Vec3 filmMean(FilmPixel p) {
    Vec3 s;
    Vec3 e;
    twoSum(p.sumA, p.sumB, s, e);
    Real n = filmCount(p);
    return n > REAL(0.0) ? (s + (e + (p.sumALow + p.sumBLow))) / n : Vec3(0.0);
}

/// Variance of the mean under independent samples: s^2 / n with s^2 the unbiased sample variance. Expected to
/// be above the true one where samples are stratified. 0 with fewer than two samples.
FN Vec3 filmVarianceOfMean(FilmPixel p) {
    Real n = filmCount(p);
    return n > REAL(1.5) ? (p.deviation + p.deviationLow) / (n - REAL(1.0)) / n : Vec3(0.0);
}

/// A number whose square is an unbiased estimate of the variance of the mean under any sampler:
/// (mean A - mean B) sqrt(a b) / (a + b), half the difference where the halves count alike. 0 without both.
FN Vec3 filmHalfDifference(FilmPixel p) {
    Real n = filmCount(p);
    if (p.countA < REAL(1.0) || p.countB < REAL(1.0)) return Vec3(0.0);
    // mean A - mean B = (A - B - (a - b) mean B) / a: sums that nearly cancel are subtracted without rounding.
    Vec3 hi = p.sumA;
    Vec3 lo = p.sumALow;
    addToDoubleSingle(hi, lo, -p.sumB);
    addToDoubleSingle(hi, lo, -p.sumBLow);
    Vec3 meanB = p.sumB / p.countB;
    return ((hi - meanB * (p.countA - p.countB)) + lo) / p.countA * (sqrt(p.countA * p.countB) / n);
}

/// Starts gathering for a pixel whose stored state is p.
FN FilmBatch startFilmBatch(FilmPixel p) {
    Vec3 zero = Vec3(0.0);
    return FilmBatch(filmMean(p), zero, zero, zero, REAL(0.0), REAL(0.0), REAL(0.0), filmCount(p) > REAL(0.0));
}

/// Samples above this are rejected as if they were infinite: 2^24 of them must not overflow a sum.
CONST Real FILM_LARGEST = REAL(1.2676506002282294e+30);  // 2^100

/// Adds a sample. One that is not finite is left out and counted.
FN void addFilmSample(INOUT(FilmBatch) b, uint sampleIndex, Vec3 value) {
    // A comparison with a NaN is false.
    bool finite = abs(value.x) <= FILM_LARGEST && abs(value.y) <= FILM_LARGEST && abs(value.z) <= FILM_LARGEST;
    // The first sample ever of a pixel is its own shift.
    b.shift = (b.shifted || !finite) ? b.shift : value;
    b.shifted = b.shifted || finite;
    Vec3 x = finite ? value - b.shift : Vec3(0.0);
    Real one = finite ? REAL(1.0) : REAL(0.0);
    bool inA = (sampleIndex & 1u) == 0u;
    b.sumA += inA ? x : Vec3(0.0);
    b.sumB += inA ? Vec3(0.0) : x;
    b.squares += x * x;
    b.countA += inA ? one : REAL(0.0);
    b.countB += inA ? REAL(0.0) : one;
    b.rejected += REAL(1.0) - one;
}

/// The stored state after the batch.
FN FilmPixel mergeFilmBatch(FilmPixel p, FilmBatch b) {
    Real n = b.countA + b.countB;
    Real stored = filmCount(p);
    p.rejected += b.rejected;
    if (n > REAL(0.0)) {
        Vec3 offset = (b.sumA + b.sumB) / n;  // batch mean - shift
        // Squares of huge samples may be infinite, and then the variance is.
        Vec3 own = b.squares - (b.sumA + b.sumB) * offset;
        own = Vec3(isinf(b.squares.x) ? b.squares.x : max(own.x, Real(0.0)),
                   isinf(b.squares.y) ? b.squares.y : max(own.y, Real(0.0)),
                   isinf(b.squares.z) ? b.squares.z : max(own.z, Real(0.0)));
        // (stored mean - shift), exact to the last bit: the shift is the rounded mean.
        Vec3 residual = Vec3(0.0);
        if (stored > REAL(0.0)) {
            Vec3 hi = p.sumA;
            Vec3 lo = p.sumALow;
            addToDoubleSingle(hi, lo, p.sumB);
            addToDoubleSingle(hi, lo, p.sumBLow);
            addProduct(hi, lo, stored, -b.shift);
            residual = (hi + lo) / stored;
        }
        Vec3 between = offset - residual;
        addToDoubleSingle(p.deviation, p.deviationLow, own + between * (between * (stored * n / (stored + n))));
        addProduct(p.sumA, p.sumALow, b.countA, b.shift);
        addToDoubleSingle(p.sumA, p.sumALow, b.sumA);
        addProduct(p.sumB, p.sumBLow, b.countB, b.shift);
        addToDoubleSingle(p.sumB, p.sumBLow, b.sumB);
        p.countA += b.countA;
        p.countB += b.countB;
    }
    return p;
}

#endif
