/* Writes the PFX_PARAMETERS values of the file, SI. */
int pfx_default_parameters(double *parameters, size_t count);

/* Runs the mechanism from its start at t = 0 for time [s]: by rk4 with step [s]; by the adaptive method of `linkwear simulate` if step
 * is 0. Out: samples rows (at least 2), evenly spaced, of PFX_CHANNELS + 1 numbers: t [s], every channel. count is PFX_PARAMETERS,
 * length that of all rows. */
int pfx_simulate(const double *parameters, size_t count, double time, double step, size_t samples, double *rows, size_t length);

/* Name and SI unit of a parameter and of a channel; null beyond the last. */
const char *pfx_parameter_name(size_t index);
const char *pfx_parameter_unit(size_t index);
const char *pfx_channel_name(size_t index);
const char *pfx_channel_unit(size_t index);
