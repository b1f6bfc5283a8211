#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define STATE 9
#define FORWARD 11

void rssr_start(double t, double state[STATE]);
void rssr_forward_dynamics(double t, const double state[STATE], double answer[FORWARD]);

int main(void) {
    double state[STATE], answer[FORWARD];
    rssr_start(0.0, state);
    rssr_forward_dynamics(0.0, state, answer);
    for (int i = 0; i < FORWARD; i++) {
        uint64_t bits;
        memcpy(&bits, &answer[i], sizeof bits);
        printf("%016" PRIx64 "\n", bits);
    }
    return 0;
}
