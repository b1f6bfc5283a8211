//! The list of all faults. A code never changes its meaning; new ones are added at the end of a group.

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Nothing is generated.
    Error,
    /// Something to look at.
    Warning,
}

macro_rules! codes {
    ($(#[doc = $title:literal] $name:ident = $text:literal,)*) => {
        /// Which fault: printed as `E0204`, warnings as `W0101`.
        ///
        /// E01 form of the file, E02 names, E03 quantities and formulas, E04 mechanics, E05 how bodies hang
        /// together, E06 assembly and rank.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Code {
            $(#[doc = $title] $name,)*
        }

        impl Code {
            /// Every code, in order.
            pub const ALL: &[Self] = &[$(Self::$name,)*];

            /// As printed.
            pub const fn as_str(self) -> &'static str {
                match self {
                    $(Self::$name => $text,)*
                }
            }

            /// What it is, in a sentence.
            pub fn title(self) -> &'static str {
                match self {
                    $(Self::$name => $title.trim_ascii(),)*
                }
            }
        }
    };
}

codes! {
    /// The file is not TOML.
    NotToml = "E0101",
    /// `spec` is missing or of a version this program does not read.
    SpecVersion = "E0102",
    /// A key or table is missing.
    MissingKey = "E0103",
    /// A key that means nothing here.
    UnknownKey = "E0104",
    /// A value of the wrong type, e.g. a number where a list is needed.
    WrongType = "E0105",
    /// A list of the wrong length.
    WrongCount = "E0106",
    /// Keys that exclude each other.
    ConflictingKeys = "E0107",
    /// Nothing says what kind of body, joint or force this is.
    NoKind = "E0108",
    /// A word that is not one of those allowed.
    BadChoice = "E0109",
    /// A `[repeat]` group that cannot be expanded.
    BadRepeat = "E0110",
    /// No bodies.
    EmptyMechanism = "E0111",
    /// More of something than can be compiled.
    TooLarge = "E0112",
    /// A file that cannot be a part of this one.
    BadInclude = "E0113",

    /// A name with other characters than letters, digits and `_`, or not starting with a letter.
    BadName = "E0201",
    /// A name that formulas use for something else.
    ReservedName = "E0202",
    /// Two things with one name.
    DuplicateName = "E0203",
    /// A name that nothing has.
    UnknownName = "E0204",
    /// A name of another kind of thing, e.g. a point where a body is needed.
    WrongKindOfName = "E0205",
    /// `--set` of a parameter that does not exist.
    UnknownOverride = "E0206",
    /// Parameters defined by each other.
    ParameterCycle = "E0207",
    /// Cells of a `[repeat]` group that make the same thing twice.
    RepeatCollision = "E0208",

    /// A formula that cannot be read.
    FormulaSyntax = "E0301",
    /// A unit that is not known.
    UnknownUnit = "E0302",
    /// A quantity of the wrong dimension.
    UnitMismatch = "E0303",
    /// A bare number where a unit is needed.
    MissingUnit = "E0304",
    /// A function that is not known, or has the wrong number of arguments.
    UnknownFunction = "E0305",
    /// Time, a coordinate or a point where only parameters may occur.
    NotAllowedHere = "E0306",
    /// A tunable parameter where the value must be fixed at generation.
    TunableNotAllowed = "E0307",
    /// A value that is infinite or not a number.
    NotFinite = "E0308",
    /// A member that this joint or point does not have.
    UnknownMember = "E0309",
    /// A drive or a surface whose position or slope would jump.
    NotSmooth = "E0310",
    /// An argument that shapes a function and cannot be so.
    BadArgument = "E0311",
    /// A table that is no function, or whose rows cannot be read.
    BadTable = "E0312",

    /// An axis without a direction.
    ZeroAxis = "E0401",
    /// Two axes that are parallel but must not be.
    ParallelAxes = "E0402",
    /// A mass, radius, length or density that is not positive.
    NotPositive = "E0403",
    /// An inertia that no body can have.
    ImpossibleInertia = "E0404",
    /// Two points that must be apart coincide.
    ZeroLength = "E0405",
    /// A screw joint that does not advance.
    ZeroLead = "E0406",
    /// A joint or force between a body and itself.
    SameBody = "E0407",
    /// A point that has positions for some bodies, used by another.
    PointNotOnBody = "E0408",
    /// A coordinate that this kind of joint does not have.
    NoSuchCoordinate = "E0409",
    /// A start value that the joint cannot take.
    BadStart = "E0410",
    /// Axes that are not at right angles but must be.
    NotPerpendicular = "E0411",
    /// Modal data that cannot be read or do not fit together.
    BadModalData = "E0412",
    /// Modes that the link cannot have.
    BadModes = "E0413",
    /// A place where a flexible body has no node.
    NoNodeHere = "E0414",
    /// Clearance or wear that a joint cannot have.
    BadClearance = "E0415",
    /// A mission that a machine cannot have.
    BadMission = "E0416",
    /// A coupling whose wheels do not fit together.
    BadCoupling = "E0417",
    /// An end stop that cannot be.
    BadStop = "E0418",
    /// A stiffness or damping matrix that cannot be.
    BadMatrix = "E0419",
    /// A controller that cannot act as it is written.
    BadController = "E0420",

    /// Bodies that no joint connects to the ground.
    Disconnected = "E0501",
    /// A joint that must be cut but carries a body.
    CutDisconnects = "E0502",
    /// Driven joints that close a loop on their own.
    DrivenLoop = "E0503",
    /// A driven joint that must be cut.
    DrivenCut = "E0504",
    /// A start value of a joint that is cut.
    StartOnCut = "E0505",
    /// A coupled joint that must be cut.
    CoupledCut = "E0506",

    /// A loop that Newton cannot close from the given start.
    LoopDoesNotClose = "E0601",
    /// Nothing can move.
    Locked = "E0602",
    /// A driver on a coordinate that the loops hold.
    DriverOnDependentCoordinate = "E0603",
    /// Drivers that the loops couple.
    DriversInConflict = "E0604",
    /// Demanded start values that cannot be met.
    StartImpossible = "E0605",
    /// Start values, residuals or prescribed motions that are not finite at t = 0.
    StartNotFinite = "E0606",
    /// A freedom that moves no mass.
    MasslessFreedom = "E0607",
    /// A start in a singular position: loops that lose rank there, or a driver at its dead point.
    SingularStart = "E0608",

    /// Gravity is not mentioned.
    NoGravity = "W0101",
    /// A bare number that is read as radians and looks like degrees.
    LooksLikeDegrees = "W0102",
    /// A unit after a number that is also a name in this file.
    UnitShadowsName = "W0103",
    /// A parameter that nothing uses.
    UnusedParameter = "W0104",
    /// A spring whose ends coincide at the reference pose.
    SpringWithoutDirection = "W0105",
    /// A frequency in Hz or rpm where an angular speed is needed.
    FrequencyAsSpeed = "W0106",
    /// Joints that never move although others do.
    RigidPart = "W0107",
    /// A harmonic of a drive near a frequency of a flexible body.
    NearResonance = "W0108",
    /// A contact that vibrates near a frequency of a flexible body.
    ContactNearMode = "W0109",
    /// A linkage that moves only thanks to its clearances.
    MovesByClearance = "W0110",
    /// A rate in Hz or rpm that becomes an angle without 2 pi.
    TurnsAsAngle = "W0111",
    /// A body far longer, shorter or thicker than the others.
    SizesApart = "W0112",
    /// A density, modulus, hardness, wear coefficient, friction or damping that no material has.
    OddMaterial = "W0113",
    /// A clearance or wear threshold that is large beside its journal.
    OddBearing = "W0114",
    /// A freedom of a driven mechanism that nothing drives, springs, brakes or starts.
    LooseBody = "W0115",
    /// Drivers that the loops do not let go on: a crank that cannot turn once round, a stroke that is too long.
    NoFullTurn = "W0116",
    /// A driven motion that passes a singular position of its loops.
    PassesSingular = "W0117",
    /// A force that would jump where the angle of a cut joint passes half a turn.
    AngleJumps = "W0118",
    /// A body far heavier than the others, or a gravity that nothing has.
    MassesApart = "W0119",
    /// A point that nothing says which body carries: it rests.
    UnplacedPoint = "W0120",
    /// Dry friction that follows a force which redundant constraints leave undetermined.
    FrictionNotUnique = "W0121",
    /// A joint keeps a section of a flexible link from turning, and its shapes do not.
    HeldAsFree = "W0122",
    /// A force element holds a point on a body that does not have it, where others do.
    HeldElsewhere = "W0123",
    /// A link of linear shapes that turns fast beside its first frequency.
    FastForOrder1 = "W0124",
    /// Modal data whose mass matrix is not that of their couplings.
    ModalMass = "W0125",
    /// A drive or a start value of a speed that no material stands.
    TooFast = "W0126",
    /// Joints of one machine whose cycles stand for different numbers of revolutions.
    UnequalCycles = "W0127",
    /// A spring whose stiffness is below zero.
    NegativeStiffness = "W0128",
}

impl Code {
    /// Error or warning, by the first letter.
    pub fn severity(self) -> Severity {
        if self.as_str().starts_with('W') { Severity::Warning } else { Severity::Error }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_in_order_within_their_letter() {
        let texts: Vec<_> = Code::ALL.iter().map(|code| code.as_str()).collect();
        for pair in texts.windows(2) {
            assert!(pair[0] < pair[1], "{pair:?}");
        }
    }
}
