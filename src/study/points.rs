//! The points of a study: a grid, or a quasi-random sample. In: what varies. Out: the values of each point, by its number.
//! Never knows a mechanism.

use linkwear_codegen::limits::STUDY_POINTS;
use sobol_burley::{NUM_DIMENSIONS, sample};
use thiserror::Error;

use super::axis::{Axis, Values};

/// All points, each by its number from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    axes: Vec<Axis>,
    /// Seed of a sample; none: the grid.
    seed: Option<u32>,
    count: u64,
}

/// What makes no points.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum PointsError {
    /// Nothing varies.
    #[error("nothing varies")]
    Nothing,
    /// A parameter is given twice.
    #[error("`{0}` varies twice")]
    Twice(String),
    /// A grid needs to know how many values.
    #[error("the range of `{name}` has no number of values: {written}")]
    NoCount {
        /// The parameter.
        name: String,
        /// The range.
        written: String,
    },
    /// A sample chooses values itself.
    #[error("the range of `{name}` has a number of values, which --sample chooses: {written}")]
    Counted {
        /// The parameter.
        name: String,
        /// The range.
        written: String,
    },
    /// There are more than a study may have.
    #[error("{count} points; {} are the most", STUDY_POINTS.most)]
    Many {
        /// How many.
        count: u128,
    },
    /// The sequence does not go so far.
    #[error("the Sobol sequence has {} points here, and {count} are asked for", Points::LONGEST)]
    Long {
        /// How many.
        count: u64,
    },
    /// The sequence has fewer dimensions.
    #[error("the Sobol sequence has {NUM_DIMENSIONS} dimensions here, and {count} parameters vary")]
    Wide {
        /// How many.
        count: usize,
    },
    /// The seed is too large for the sequence.
    #[error("the seed of a Sobol sequence is below 2^32, and {0} is not")]
    Seed(u64),
}

impl Points {
    /// Points of the longest sample.
    pub const LONGEST: u64 = 1 << 16;

    /// Every value of each with every value of the others, the last one varying fastest.
    ///
    /// # Errors
    /// [`PointsError`].
    pub fn grid(axes: Vec<Axis>) -> Result<Self, PointsError> {
        check(&axes)?;
        let mut count = 1_u128;
        for axis in &axes {
            let no_count = || PointsError::NoCount { name: axis.name.clone(), written: axis.written.clone() };
            count = count.saturating_mul(axis.count().ok_or_else(no_count)?.into());
        }
        let few = u64::try_from(count).ok().filter(|count| *count <= STUDY_POINTS.most as u64);
        Ok(Self { axes, seed: None, count: few.ok_or(PointsError::Many { count })? })
    }

    /// So many points of a Sobol sequence, scrambled (Owen) by the seed: the first 2^k of them fill every half, quarter, .. of
    /// every range evenly. A list is picked from by its coordinate.
    ///
    /// # Errors
    /// [`PointsError`].
    pub fn sobol(axes: Vec<Axis>, count: u64, seed: u64) -> Result<Self, PointsError> {
        check(&axes)?;
        if axes.len() > NUM_DIMENSIONS as usize {
            return Err(PointsError::Wide { count: axes.len() });
        }
        if let Some(axis) =
            axes.iter().find(|axis| matches!(&axis.values, Values::Range(range) if range.count.is_some()))
        {
            return Err(PointsError::Counted { name: axis.name.clone(), written: axis.written.clone() });
        }
        if count > Self::LONGEST {
            return Err(PointsError::Long { count });
        }
        let seed = u32::try_from(seed).map_err(|_| PointsError::Seed(seed))?;
        Ok(Self { axes, seed: Some(seed), count })
    }

    /// What varies.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// How many points there are.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Whether they are a sample.
    pub fn is_sample(&self) -> bool {
        self.seed.is_some()
    }

    /// Names and values of a point, as `--set` takes them.
    pub fn values(&self, point: u64) -> Vec<(String, String)> {
        let Some(seed) = self.seed else { return self.of_grid(point) };
        let index = u32::try_from(point).unwrap_or(0);
        let value = |(axis, dimension): (&Axis, u32)| {
            (axis.name.clone(), axis.at(f64::from(sample(index, dimension, seed))))
        };
        self.axes.iter().zip(0..).map(value).collect()
    }

    fn of_grid(&self, mut point: u64) -> Vec<(String, String)> {
        let mut values = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            let count = axis.count().unwrap_or(1).max(1);
            values.push((axis.name.clone(), axis.of_grid(point % count)));
            point /= count;
        }
        values.reverse();
        values
    }
}

fn check(axes: &[Axis]) -> Result<(), PointsError> {
    let twice = |(at, axis): &(usize, &Axis)| axes[..*at].iter().any(|one| one.name == axis.name);
    match axes.iter().enumerate().find(twice) {
        _ if axes.is_empty() => Err(PointsError::Nothing),
        Some((_, axis)) => Err(PointsError::Twice(axis.name.clone())),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(texts: &[&str]) -> Vec<Axis> {
        texts.iter().map(|text| Axis::parse(text).expect("an axis")).collect()
    }

    #[test]
    fn the_last_one_varies_fastest() {
        let points = Points::grid(axes(&["a=1,2", "b=3..5:3"])).expect("a grid");
        let all: Vec<String> = (0..points.count())
            .map(|at| points.values(at).into_iter().map(|(_, value)| value).collect::<String>())
            .collect();
        assert_eq!(all, ["13", "14", "15", "23", "24", "25"]);
    }

    #[test]
    fn a_sample_fills_every_cell_of_a_halved_square_evenly() {
        for seed in [0, 1, 7, u64::from(u32::MAX)] {
            let points = Points::sobol(axes(&["a=0..1", "b=0..1"]), 256, seed).expect("a sample");
            // Elementary intervals of area 1/16: four ways to cut, 16 points in each cell.
            for (columns, rows) in [(16.0, 1.0), (8.0, 2.0), (4.0, 4.0), (1.0, 16.0)] {
                let mut cells = vec![0; 16];
                for at in 0..256 {
                    let [x, y]: [f64; 2] = points
                        .values(at)
                        .iter()
                        .map(|(_, value)| value.parse().expect("a number"))
                        .collect::<Vec<_>>()
                        .try_into()
                        .expect("two");
                    assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                    cells[((x * columns).floor() * rows + (y * rows).floor()) as usize] += 1;
                }
                assert_eq!(cells, [16; 16], "seed {seed}");
            }
        }
        let of = |seed| Points::sobol(axes(&["a=0..1"]), 8, seed).expect("a sample").values(3);
        assert_eq!(of(1), of(1));
        assert_ne!(of(1), of(2));
        // A list by its coordinate: each of four values a quarter of the points.
        let points = Points::sobol(axes(&["a=p,q,r,s"]), 64, 3).expect("a sample");
        for value in ["p", "q", "r", "s"] {
            assert_eq!((0..64).filter(|at| points.values(*at)[0].1 == value).count(), 16);
        }
    }

    #[test]
    fn what_makes_no_points_is_told() {
        use PointsError::{Counted, Long, Many, NoCount, Nothing, Seed, Twice, Wide};
        assert_eq!(Points::grid(Vec::new()), Err(Nothing));
        assert_eq!(Points::grid(axes(&["a=1", "a=2"])), Err(Twice("a".into())));
        assert!(matches!(Points::grid(axes(&["a=1..2"])), Err(NoCount { .. })));
        assert!(matches!(
            Points::grid(axes(&["a=1..2:1000", "b=1..2:1001"])),
            Err(Many { count: 1_001_000 })
        ));
        assert!(matches!(Points::sobol(axes(&["a=1..2:3"]), 4, 1), Err(Counted { .. })));
        assert_eq!(Points::sobol(axes(&["a=1..2"]), 65_537, 1), Err(Long { count: 65_537 }));
        assert_eq!(Points::sobol(axes(&["a=1..2"]), 4, 1 << 32), Err(Seed(1 << 32)));
        let many: Vec<String> = (0..257).map(|at| format!("a{at}=1..2")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert_eq!(Points::sobol(axes(&many), 4, 1), Err(Wide { count: 257 }));
    }
}
