#include <cstdio>

#include "mechanism.h"

int main()
{
    rssr_parameters parameters = rssr_default_parameters;
    double x[RSSR_PARAMETERS];
    rssr_set_parameters(&parameters, x);
    if (x[RSSR_PARAMETER_speed] != rssr_parameter_table[RSSR_PARAMETER_speed].value) {
        return 1;
    }
    std::printf("%s %s %s %s\n", rssr_name, rssr_contact_table[RSSR_CONTACT_OF_R1].joint,
                rssr_parameter_table[RSSR_PARAMETER_speed].name, rssr_parameter_table[RSSR_PARAMETER_speed].unit);
    return 0;
}
