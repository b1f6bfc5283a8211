/* What examples/c/cortex-m does, on this machine: bits of the state after a thousand steps. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "rssr_rigid.h"

int main(void)
{
    double parameters[RSSR_RIGID_PARAMETERS];
    double y[RSSR_RIGID_STATE] = {0.0};
    rssr_rigid_memory memory;
    int i, status;
    rssr_rigid_set_parameters(&rssr_rigid_default_parameters, parameters);
    memcpy(y, rssr_rigid_start_state, sizeof rssr_rigid_start_state);
    status = rssr_rigid_begin(parameters, 0.0, y, &memory);
    for (i = 0; status == RSSR_RIGID_DONE && i < 1000; ++i) {
        status = rssr_rigid_rk4_step(parameters, i * 1e-4, 1e-4, y, &memory);
    }
    for (i = 0; i < RSSR_RIGID_STATE; ++i) {
        uint64_t bits;
        memcpy(&bits, y + i, sizeof bits);
        printf("y %016" PRIx64 "\n", bits);
    }
    return status;
}
