/* Turns the crank of the RSSR once by the library of the c-abi target, and looks at the rocker. */
#include <stdio.h>

#include "rssr_rigid.h"

enum { ROWS = 101, WIDTH = RSSR_RIGID_CHANNELS + 1 };

int main(void)
{
    static double rows[ROWS * WIDTH];
    double parameters[RSSR_RIGID_PARAMETERS];
    const double *const last = rows + (ROWS - 1) * WIDTH;
    int status = rssr_rigid_default_parameters(parameters, RSSR_RIGID_PARAMETERS);
    if (status == RSSR_RIGID_DONE) {
        status = rssr_rigid_simulate(parameters, RSSR_RIGID_PARAMETERS, 0.5, 1e-4, ROWS, rows, ROWS * WIDTH);
    }
    if (status != RSSR_RIGID_DONE) {
        printf("status %d\n", status);
        return 1;
    }
    printf("%s = %.12f %s\n", rssr_rigid_channel_name(RSSR_RIGID_CHANNEL_R4_q), last[1 + RSSR_RIGID_CHANNEL_R4_q],
           rssr_rigid_channel_unit(RSSR_RIGID_CHANNEL_R4_q));
    /* Mistakes come back as a status. */
    printf("no address: status %d\n", rssr_rigid_energy(NULL, RSSR_RIGID_ENERGY_IN, rows, RSSR_RIGID_ENERGY_OUT));
    return 0;
}
