/* A tunable parameter: name in the file, SI unit ("1" without one), value in the file. */
typedef struct {
    const char *name;
    const char *unit;
    double value;
} pfx_parameter_info;

/* A coordinate or speed: name, SI unit, whether its start value was demanded in the file. */
typedef struct {
    const char *name;
    const char *unit;
    int held;
} pfx_variable_info;

/* A group of coordinates and speeds, driven ones included. kind 0: one and one, with its driver or -1; 1: unit quaternion (4, scalar
 * first) and angular velocity in the body's frame (3); 2: quaternion and position (7), angular and linear velocity (6). */
typedef struct {
    int kind;
    int driver;
} pfx_motion_info;

/* A constraint row: joint that it closes, what it forbids, 1 for rad and 0 for m, place among kept rows or -1. */
typedef struct {
    const char *joint;
    const char *meaning;
    int angular;
    int kept;
} pfx_row_info;

/* A driver: its joint, 1 for an angle and 0 for a length. */
typedef struct {
    const char *joint;
    int angular;
} pfx_driver_info;

/* An output of pfx_observe: name, SI unit, 1 for an angle that jumps by 2 pi. */
typedef struct {
    const char *name;
    const char *unit;
    int wraps;
} pfx_channel_info;

/* A joint with clearance: laws by their names and numbers, SI. Texts of laws without friction or wear are empty. */
typedef struct {
    const char *joint;
    int ball;
    double journal_radius;
    double length;
    double modulus;
    double restitution;
    double exponent;
    double impact_speed_floor;
    const char *stiffness;
    const char *restitution_law;
    const char *friction_strength;
    const char *friction_onset;
    double friction_slope;
    int wears;
    double wear_coefficient;
    double hardness;
    const char *area;
    double feedback;
    double threshold;
    double revolutions_per_cycle;
    double alpha;
    double beta;
} pfx_contact_info;
