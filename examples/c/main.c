/* Turns the crank of the RSSR once, in steps of a tenth of a millisecond, and looks at the rocker and the drive. */
#include <stdio.h>

#include "rssr_rigid.h"

int main(void)
{
    double parameters[RSSR_RIGID_PARAMETERS];
    double y[RSSR_RIGID_STATE];
    rssr_rigid_memory memory;
    rssr_rigid_parameters own = rssr_rigid_default_parameters;
    const double step = 1e-4;
    int i, status;

    /* Tunable parameters are fields, in SI. */
    own.speed = 2.0;
    rssr_rigid_set_parameters(&own, parameters);

    /* The start of the file, with these parameters. */
    status = rssr_rigid_take_start(parameters, 0.0, y, &memory);
    for (i = 0; status == RSSR_RIGID_DONE && i < 5000; ++i) {
        status = rssr_rigid_rk4_step(parameters, i * step, step, y, &memory);
    }
    if (status != RSSR_RIGID_DONE) {
        printf("stopped after %d steps, status %d\n", i, status);
        return 1;
    }
    printf("%s = %.12f %s\n", rssr_rigid_coordinates[RSSR_RIGID_Q_R4_q].name, y[RSSR_RIGID_Q_R4_q],
           rssr_rigid_coordinates[RSSR_RIGID_Q_R4_q].unit);
    printf("work of the drive = %.9f J\n", y[RSSR_RIGID_COORDINATES + RSSR_RIGID_SPEEDS]);
    return 0;
}
