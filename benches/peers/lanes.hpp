// Eight numbers side by side (AVX-512) as the number type of C code that CasADi wrote, sines by glibc's vector library.
#pragma once
#include <immintrin.h>

extern "C" {
__m512d _ZGVeN8v_sin(__m512d);
__m512d _ZGVeN8v_cos(__m512d);
}

struct Lanes {
    __m512d all;
    Lanes(double value = 0.0) : all(_mm512_set1_pd(value)) {}
    Lanes(__m512d value) : all(value) {}
};
static inline Lanes operator+(Lanes a, Lanes b) { return _mm512_add_pd(a.all, b.all); }
static inline Lanes operator-(Lanes a, Lanes b) { return _mm512_sub_pd(a.all, b.all); }
static inline Lanes operator*(Lanes a, Lanes b) { return _mm512_mul_pd(a.all, b.all); }
static inline Lanes operator/(Lanes a, Lanes b) { return _mm512_div_pd(a.all, b.all); }
static inline Lanes operator-(Lanes a) { return _mm512_sub_pd(_mm512_setzero_pd(), a.all); }
static inline Lanes sin(Lanes a) { return _ZGVeN8v_sin(a.all); }
static inline Lanes cos(Lanes a) { return _ZGVeN8v_cos(a.all); }
static inline Lanes sqrt(Lanes a) { return _mm512_sqrt_pd(a.all); }
