//? rotation
/* Unit quaternion (scalar first) times the rotation by a vector [rad] in the body's own frame. */
static void pfx_rotate(double *q, double x, double y, double z)
{
    const double half = 0.5 * sqrt(x * x + y * y + z * z);
    const sine_cosine_pair turn = sine_cosine(half);
    /* sin(half) / (2 half); below 1e-4 the next term of the series is 1e-18. */
    const double factor = half < 1e-4 ? 0.5 - half * half / 12.0 : 0.5 * turn.sine / half;
    const double b0 = turn.cosine, b1 = factor * x, b2 = factor * y, b3 = factor * z;
    const double a0 = q[0], a1 = q[1], a2 = q[2], a3 = q[3];
    q[0] = a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3;
    q[1] = a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2;
    q[2] = a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1;
    q[3] = a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0;
}

//.
//? pose
/* Vector product. */
static void pfx_cross(const double *a, const double *b, double *product)
{
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

/* Pose times the exponential of a twist in the body's own frame. */
static void pfx_displace(double *q, const double *angle, const double *shift)
{
    const double square = angle[0] * angle[0] + angle[1] * angle[1] + angle[2] * angle[2];
    const double size = sqrt(square);
    const sine_cosine_pair turn = sine_cosine(size);
    /* (1 - cos)/x^2 and (x - sin)/x^3; the series' next terms are 1e-13 of x^4 below 1e-2. */
    const int is_small = size < 1e-2;
    const double a = is_small ? 0.5 - square / 24.0 + square * square / 720.0 : (1.0 - turn.cosine) / square;
    const double b = is_small ? 1.0 / 6.0 - square / 120.0 + square * square / 5040.0
                              : (size - turn.sine) / (square * size);
    double once[3], twice[3], moved[3];
    int i;
    pfx_cross(angle, shift, once);
    pfx_cross(angle, once, twice);
    for (i = 0; i < 3; ++i) {
        moved[i] = shift[i] + a * once[i] + b * twice[i];
    }
    pfx_cross(q + 1, moved, once);
    pfx_cross(q + 1, once, twice);
    for (i = 0; i < 3; ++i) {
        q[4 + i] += moved[i] + 2.0 * (q[0] * once[i] + twice[i]);
    }
    pfx_rotate(q, angle[0], angle[1], angle[2]);
}

//.
//? quaternions
/* Makes a quaternion one of unit length. */
static void pfx_unit(double *q)
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    int i;
    for (i = 0; i < 4; ++i) {
        q[i] = q[i] / length;
    }
}

//.
