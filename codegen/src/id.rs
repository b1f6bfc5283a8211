//! Typed indices, so that a body's number cannot be used as a joint's.
//! Knows nothing else.

macro_rules! typed_index {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u32);

        impl $name {
            /// The index `position` as a typed index.
            ///
            /// # Panics
            /// Beyond 2^32 entries.
            #[inline]
            pub fn new(position: usize) -> Self {
                Self(u32::try_from(position).expect("fewer than 2^32 entries"))
            }

            /// Position in the list that this index belongs to.
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// The same as it is kept.
            pub const fn number(self) -> u32 {
                self.0
            }
        }
    };
}

typed_index!(
    /// A body of a mechanism; ground is not a body.
    BodyId
);
typed_index!(
    /// A joint of a mechanism.
    JointId
);
typed_index!(
    /// A force element of a mechanism.
    ForceId
);
typed_index!(
    /// A named point of a mechanism.
    PointId
);
typed_index!(
    /// A parameter of a mechanism.
    ParameterId
);
typed_index!(
    /// A state variable of a file's own.
    StateId
);
typed_index!(
    /// A node of an expression graph.
    ExprId
);
typed_index!(
    /// An input symbol of an expression graph.
    SymbolId
);
