//! What the codes of the command line mean, with a command line that gives them and one that does not. `tests/cli/explain.rs`
//! runs them.

/// A code of the command line.
pub struct Command {
    pub code: &'static str,
    pub title: &'static str,
    pub text: &'static str,
    /// Commands of which the last one says it.
    pub wrong: &'static str,
    pub right: &'static str,
}

/// All of them, in order; then the words under which JSON has remarks on what was done with a file.
pub const COMMANDS: &[Command] = &[
    Command {
        code: "C0001",
        title: "Arguments that do not fit this mechanism or each other.",
        text: "The command line is wrong, not the file: the exit status is 2. A turn, for instance, is one of the first driven \
               revolute joint, and a pendulum has none.",
        wrong: "linkwear simulate mechanisms/pendulum.toml --turns 1",
        right: "linkwear simulate mechanisms/pendulum.toml --time 1",
    },
    Command {
        code: "C0002",
        title: "A file that cannot be read.",
        text: "It does not exist, is a folder, is no text, or may not be read.",
        wrong: "linkwear check mechanism/pendulum.toml",
        right: "linkwear check mechanisms/pendulum.toml",
    },
    Command {
        code: "C0003",
        title: "A file that cannot be written.",
        text: "The folder does not exist or may not be written, or the disk is full. Files appear whole or not at all, so nothing \
               was changed.",
        wrong: "linkwear simulate mechanisms/pendulum.toml --out no_such_folder/rows.csv",
        right: "linkwear simulate mechanisms/pendulum.toml --out rows.csv",
    },
    Command {
        code: "C0004",
        title: "A file or folder that exists already and is not written over.",
        text: "linkwear replaces files that it made itself, others only with --force, and of a mechanism file or a used folder of a life \
               nothing at all.",
        wrong: "linkwear new press && linkwear new press",
        right: "linkwear new press && linkwear new press2",
    },
    Command {
        code: "C0005",
        title: "Generated code that is not what the mechanism gives.",
        text: "`generate --check` compares and writes nothing, for tests of code that is kept beside its mechanism. Run it \
               without --check to bring the code up to date.",
        wrong: "linkwear generate mechanisms/pendulum.toml -o swing.rs && linkwear generate mechanisms/four_bar.toml -o swing.rs --check",
        right: "linkwear generate mechanisms/pendulum.toml -o swing.rs && linkwear generate mechanisms/pendulum.toml -o swing.rs --check",
    },
    Command {
        code: "C0006",
        title: "A name on the command line that does not exist.",
        text: "An output, a parameter or a result that this mechanism does not have. The message has the nearest one, or all.",
        wrong: "linkwear equations mechanisms/pendulum.toml --only mas",
        right: "linkwear equations mechanisms/pendulum.toml --only mass",
    },
    Command {
        code: "C0007",
        title: "A back end that cannot run this mechanism here.",
        text: "Compiled code exists only for shipped files, unchanged; machine code only on some processors. All back ends give \
               the same bits, so `--backend auto` loses nothing but time.",
        wrong: "linkwear new press && linkwear simulate press.toml --backend compiled",
        right: "linkwear new press && linkwear simulate press.toml --backend auto",
    },
    Command {
        code: "C0008",
        title: "A run that failed.",
        text: "The motion cannot go on: a driver pushes past a dead point, a loop comes apart, a journal is pressed deep into its \
               bearing, a link bends by more than its length, a force has no value, or steps shrink to nothing. The message says when and why; `check` warns of most \
               causes beforehand. A coarse step does it too.",
        wrong: "linkwear simulate mechanisms/rssr.toml --integrator rk4 --step 2e-3",
        right: "linkwear simulate mechanisms/rssr.toml --integrator rk4 --step 2e-5",
    },
    Command {
        code: "C0009",
        title: "Stopped on request.",
        text: "Ctrl-C, or a system that asked the program to end. What was finished is kept; with --out, --resume goes on to the \
               same bits.",
        wrong: "linkwear life mechanisms/rssr.toml --out lives    (and Ctrl-C)",
        right: "linkwear life mechanisms/rssr.toml --out lives --resume",
    },
    Command {
        code: "C0010",
        title: "A life that cannot be lived to its end.",
        text: "No joint wears, wear stands still, a cycle passes the whole threshold at once, none of 100,000 cycles passes it, \
               the clearance outgrows what the mechanism can run with, or loads never repeat, so that no turn stands for others. A cycle stands for `revolutions_per_cycle` revolutions, 1 unless \
               [wear] says otherwise; 10 to 100 cycles to the end are good.",
        wrong: "linkwear life mechanisms/four_bar.toml",
        right: "linkwear life mechanisms/rssr.toml --trajectories 10",
    },
    Command {
        code: "C0011",
        title: "A file with data or results that is wrong.",
        text: "A CSV without the column that is asked for, a cell that is no number, times that fall, a fit that is none, a robot \
               whose joints form a circle, a mesh that is not closed. The message has the line.",
        wrong: "linkwear fit examples/data/sliding_wear_100g.csv --unit unit --wear wear --exposure cycles",
        right: "linkwear fit examples/data/sliding_wear_100g.csv --unit unit --wear wear_um --exposure cycles --from-zero --power-law",
    },
    Command {
        code: "C0012",
        title: "The paper's case study failed.",
        text: "Of the program of the case study alone, which is no command of linkwear: a run, a life, a fit or a picture of it could \
               not be made, as the message says. Nothing was written. Its mechanism is mechanisms/rssr.toml, whose names it goes by.",
        wrong: "cargo run --release -p linkwear-case-study -- --out study    (with another joint R1 in mechanisms/rssr.toml)",
        right: "cargo run --release -p linkwear-case-study -- --quick --out study",
    },
    Command {
        code: "C0013",
        title: "A run that was interrupted and cannot be gone on with.",
        text: "The folder belongs to a run with another file, other options or another version, is in use, or was damaged. Going \
               on would mix two results.",
        wrong: "linkwear life mechanisms/rssr.toml --trajectories 10 --out lives && linkwear life mechanisms/rssr.toml --trajectories 10 --seed 2 --out lives --resume",
        right: "linkwear life mechanisms/rssr.toml --trajectories 10 --out lives && linkwear life mechanisms/rssr.toml --trajectories 10 --out lives --resume",
    },
    Command {
        code: "C0014",
        title: "Shards that cannot be put together.",
        text: "One is missing, one is given that is none, or they are of different studies, versions or builds.",
        wrong: "linkwear life mechanisms/rssr.toml --trajectories 10 --shard 1/2 --out a && linkwear merge a --out all",
        right: "linkwear life mechanisms/rssr.toml --trajectories 10 --shard 1/2 --out a && linkwear life mechanisms/rssr.toml --trajectories 10 --shard 2/2 --out b && linkwear merge a b --out all",
    },
    Command {
        code: "C0015",
        title: "A study in which nothing could be run.",
        text: "The mechanism is right, but at no point of the study: look at the ranges.",
        wrong: "linkwear study mechanisms/four_bar.toml --vary a=500mm,600mm --of steps",
        right: "linkwear study mechanisms/four_bar.toml --vary a=90mm,100mm --of steps",
    },
    Command {
        code: "C0016",
        title: "A parameter that changes nothing of what was measured.",
        text: "`identify` varies every free parameter and looks at the predictions: where they stay the same to the last bit, no \
               measurement of this kind tells the parameter. The restitution of a joint, for instance, is not in a curve of a \
               mechanism whose joints have no clearance, and the speed of its drive is not in the angle of a body at rest.",
        wrong: "linkwear simulate mechanisms/four_bar.toml --out curve.csv && linkwear identify mechanisms/four_bar.toml --free b=290mm..310mm --measured curve.csv --of R1.q",
        right: "linkwear simulate mechanisms/four_bar.toml --out curve.csv && linkwear identify mechanisms/four_bar.toml --free b=290mm..310mm --measured curve.csv --of R4.q",
    },
    Command {
        code: "C0017",
        title: "A target that knows no controllers at sampled times.",
        text: "Steps of generated C know nothing of samples: a controller with `sample_time` would hold its first output for ever. Rust \
               and units of FMI in co-simulation sample themselves; a program in C can set an input at its own samples.",
        wrong: "linkwear generate examples/data/sampled_servo.toml --target c -o servo",
        right: "linkwear generate examples/data/sampled_servo.toml -o servo.rs",
    },
    Command {
        code: "run",
        title: "A remark on a run.",
        text: "The numbers are there, and something about them is doubtful: a step too coarse for its contacts, a penetration that \
               is large beside the clearance, a motion near a singular position. In JSON these stand under `warnings`.",
        wrong: "linkwear simulate mechanisms/rssr.toml --integrator rk4 --step 5e-5",
        right: "linkwear simulate mechanisms/rssr.toml --integrator rk4 --step 2e-5",
    },
    Command {
        code: "life",
        title: "A remark on a life.",
        text: "The numbers are there, and something about them is doubtful: cycles that wear too much at once, a contact wider than \
               Hertz's law is meant for, a pressure beyond its limit. In JSON these stand under `warnings`.",
        wrong: "linkwear new press && linkwear life press.toml --trajectories 10 --set play=5um",
        right: "linkwear new press && linkwear life press.toml --trajectories 10",
    },
];
