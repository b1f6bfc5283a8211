/* Turns the crank once in steps of ten microseconds; nothing is allocated. */
#include <stddef.h>
#include <stdio.h>

extern const size_t RSSR_RUN;
int rssr_begin(void *run);
int rssr_step(void *run, double end);
int rssr_observe(void *run, double answer[3]);

int main(void) {
    static double run[4096];
    double answer[3];
    if (RSSR_RUN > sizeof run) {
        printf("a run takes %zu bytes\n", RSSR_RUN);
        return 1;
    }
    int status = rssr_begin(run);
    for (int i = 1; status == 0 && i <= 50000; i++) {
        status = rssr_step(run, 0.5 * (i / 50000.0));
    }
    if (status == 0) {
        status = rssr_observe(run, answer);
    }
    if (status != 0) {
        printf("stopped: %d\n", status);
        return 1;
    }
    printf("angle of the rocker  %.17g rad\n", answer[0]);
    printf("force in the bearing %.17g N\n", answer[1]);
    printf("its wear integral    %.17g J\n", answer[2]);
    return 0;
}
