//? journals
/* An angle brought to (-pi, pi]. */
static double pfx_around(double angle)
{
    const double turn = 6.283185307179586;
    double rest = fmod(angle, turn);
    rest = rest < 0.0 ? rest + turn : rest;
    return rest > 3.141592653589793 ? rest - turn : rest;
}

//.
/* All columns of a run at a flat state, laws of contact included, rates of coordinates and speeds, penetrations. In: contacts, as
 * pfx_memory has them. Arrays have one place more than they use. */
static void pfx_outputs(const double *parameters, double t, const double *y, const double *contacts, double *columns,
                        double *rates, double *depths)
{
    double x[PFX_DERIVATIVE_IN];
    double asked[PFX_OBSERVE_IN];
    double answer[PFX_DERIVATIVE_OUT];
    double w[PFX_WORKSPACE + 1];
    const int state_end = PFX_PARAMETERS + 1 + PFX_COORDINATES + PFX_SPEEDS;
    double *next = asked + state_end;
    int i;
QUESTION
//? contacts
    {
        const double *const motions = x + PFX_FORWARD_DYNAMICS_IN;
        double laws[PFX_CONTACT_ANSWER * PFX_CONTACTS];
        pfx_contacts(x, x + PFX_FORWARD_DYNAMICS_IN, w);
        pfx_contact_laws(motions, contacts, laws);
        for (i = 0; i < PFX_CONTACTS; ++i) {
            int k;
            for (k = 0; k < 6; ++k) {
                x[state_end + 6 * i + k] = laws[PFX_CONTACT_ANSWER * i + k];
            }
            depths[i] = laws[PFX_CONTACT_ANSWER * i + 10];
        }
        {
CONTACT_COLUMNS
        }
    }
//? no contacts
    (void)contacts;
    (void)depths;
//.
    pfx_derivative(x, answer, w);
    for (i = 0; i < PFX_COORDINATES + PFX_SPEEDS; ++i) {
        rates[i] = answer[i];
    }
    for (i = 0; i < state_end; ++i) {
        asked[i] = x[i];
    }
    for (i = 0; i < PFX_SPEEDS; ++i) {
        *next++ = answer[PFX_COORDINATES + i];
    }
//? all rows
    for (i = 0; i < PFX_ALL_ROWS; ++i) {
        *next++ = pfx_rows[i].kept < 0 ? 0.0 : answer[PFX_COORDINATES + PFX_SPEEDS + pfx_rows[i].kept];
    }
//.
    for (i = 0; i < PFX_DRIVERS; ++i) {
        *next++ = answer[PFX_COORDINATES + PFX_SPEEDS + PFX_ROWS + i];
    }
    for (i = 0; i < 6 * PFX_CONTACTS; ++i) {
        *next++ = x[state_end + i];
    }
    pfx_observe(asked, columns, w);
}
