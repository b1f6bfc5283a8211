// Nanoseconds per state of a function that CasADi wrote, eight states side by side: the least of the batches, over 64 inputs in turn.
#include "lanes.hpp"
#define casadi_real Lanes
#include SOURCE
#include <cstdio>
#include <time.h>

int main() {
    const int batches = 401, calls = 500, inputs = 64;
    static Lanes in[inputs][IN], out[OUT + 1], w[SIZE_W + 1];
    static long long int iw[SIZE_IW + 1];
    const Lanes *arg[SIZE_ARG + 1] = {0};
    Lanes *res[SIZE_RES + 1] = {0};
    for (int i = 0; i < inputs; i++)
        for (int j = 0; j < IN; j++) {
            double value;
            if (scanf("%lf", &value) != 1) return 1;
            in[i][j] = Lanes(value);
        }
    res[0] = out;
    double least = 1e9;
    for (int batch = 0; batch < batches; batch++) {
        struct timespec begin, end;
        clock_gettime(CLOCK_MONOTONIC, &begin);
        for (int call = 0; call < calls; call++) {
            arg[0] = in[call % inputs];
            FUNCTION(arg, res, iw, w, 0);
        }
        clock_gettime(CLOCK_MONOTONIC, &end);
        double ns = ((end.tv_sec - begin.tv_sec) * 1e9 + (end.tv_nsec - begin.tv_nsec)) / calls / 8;
        least = ns < least ? ns : least;
    }
    printf("%.3f\n", least);
    return 0;
}
