//! What a life is used for: the mission that was chosen, its segments as they run. In: a study. Out: a source of wear for each
//! segment, and how much of the mission it is. Never knows what they wear.

use linkwear_runtime::life::{MissionError, MissionSegment, MissionSource, WearSource};
use linkwear_runtime::{
    Description, DynamicsSource, MissionInfo, RevolutionSettings, RunError, SegmentInfo, System, Watch,
};

use super::error::Cause;
use super::mission_choice::MissionChoice;
use super::study::LifeStudy;

/// Part of a segment's revolution in contact below which wear by sliding means nothing, as it is of a whole life.
const LEAST_TOUCHING: f64 = 0.5;

/// A segment as it runs.
pub(super) struct Setup {
    pub name: String,
    description: Description,
    parameters: Vec<f64>,
    /// Duration [s], where the mission has durations.
    pub duration: Option<f64>,
    /// Share of the time.
    pub time: f64,
    /// Share of the revolutions.
    pub revolutions: f64,
    /// How long a revolution lasts [s].
    pub seconds: Option<f64>,
    /// Parameters and inputs that differ from those of the mechanism, in SI.
    pub set: Vec<(String, f64)>,
    /// By how much clearances differ from those of the first segment [m].
    clearances: Vec<f64>,
}

/// All segments.
pub(super) struct Duty {
    /// Name of the mission; nothing if there is none and the one segment is the mechanism as it is.
    pub name: Option<String>,
    pub setups: Vec<Setup>,
}

impl LifeStudy<'_> {
    /// The mission of this study.
    ///
    /// # Errors
    /// [`Cause::UnknownMission`], [`Cause::SeveralMissions`].
    pub fn chosen_mission(&self) -> Result<Option<&MissionInfo>, Cause> {
        let all = &self.mechanism.description.missions;
        let names = || all.iter().map(|mission| mission.name.to_string()).collect();
        match (&self.mission, &all[..]) {
            (MissionChoice::None, _) | (MissionChoice::Only, []) => Ok(None),
            (MissionChoice::Only, [only]) => Ok(Some(only)),
            (MissionChoice::Only, _) => Err(Cause::SeveralMissions { known: names() }),
            (MissionChoice::Named(name), all) => {
                let found = all.iter().find(|mission| mission.name == *name);
                let unknown = || Cause::UnknownMission { mission: name.clone(), known: names() };
                found.map(Some).ok_or_else(unknown)
            }
        }
    }

    /// The name of the mission, if every segment of it gives this parameter or input a value of its own. These count after the
    /// mechanism's, so that the life does not depend on it. A mission that cannot be chosen is told by the life itself.
    pub(crate) fn set_throughout(&self, name: &str) -> Option<&str> {
        let mission = self.chosen_mission().ok()??;
        let place = self.mechanism.description.parameters.iter().position(|known| known.name == *name)?;
        let sets = |segment: &SegmentInfo| segment.values.iter().any(|(at, _)| *at == place);
        mission.segments.iter().all(sets).then_some(&*mission.name)
    }

    /// A warning for everything that the mechanism's options set in vain.
    pub(super) fn set_in_vain(&self) -> impl Iterator<Item = String> {
        let told = |name| {
            let mission = self.set_throughout(name)?;
            Some(format!(
                "every segment of mission `{mission}` sets `{name}`: the value by --set changes nothing; change the mission, or live \
                 without it"
            ))
        };
        self.mechanism.given().filter_map(told)
    }
}

impl Duty {
    /// That of a study's mission; `system` runs its equations.
    pub fn new(study: &LifeStudy<'_>, system: &dyn System<f64>) -> Result<Self, Cause> {
        match study.chosen_mission()? {
            Some(mission) => Self::of(study, system, mission, &mission.segments),
            None => Self::without(study, system),
        }
    }

    /// The same in half as many bins, where the mission is a measured series.
    pub fn coarser(study: &LifeStudy<'_>, system: &dyn System<f64>) -> Result<Option<Self>, Cause> {
        let mission = study.chosen_mission()?.filter(|mission| !mission.coarser.is_empty());
        mission.map(|mission| Self::of(study, system, mission, &mission.coarser)).transpose()
    }

    /// The mechanism as it is, all the time.
    fn without(study: &LifeStudy<'_>, system: &dyn System<f64>) -> Result<Self, Cause> {
        let mechanism = study.mechanism;
        let whole = Setup {
            name: String::new(),
            description: mechanism.description.clone(),
            parameters: mechanism.parameters.clone(),
            duration: None,
            time: 1.0,
            revolutions: 1.0,
            seconds: None,
            set: Vec::new(),
            clearances: Vec::new(),
        };
        let mut duty = Self { name: None, setups: vec![whole] };
        let source = duty.sources(system, study.revolutions, Watch::NONE)?.pop();
        let seconds = source.map(|mut source| source.seconds_per_revolution()).transpose();
        duty.setups[0].seconds = match seconds {
            Err(never @ RunError::TurnsNotReached { .. }) => return Err(never.into()),
            seconds => seconds.ok().flatten().flatten(),
        };
        Ok(duty)
    }

    fn of(
        study: &LifeStudy<'_>,
        system: &dyn System<f64>,
        mission: &MissionInfo,
        segments: &[SegmentInfo],
    ) -> Result<Self, Cause> {
        let mechanism = study.mechanism;
        let whole: f64 = segments.iter().map(|segment| segment.amount).sum();
        let named = |(place, value): &(usize, f64)| {
            Some((mechanism.description.parameters.get(*place)?.name.to_string(), *value))
        };
        let setup = |segment: &SegmentInfo| Setup {
            name: segment.name.to_string(),
            description: mechanism.description.in_segment(segment),
            parameters: segment.parameters(&mechanism.parameters),
            duration: mission.ordered.then_some(segment.amount),
            time: if segments.len() == 1 { 1.0 } else { segment.amount / whole },
            revolutions: 1.0,
            seconds: None,
            set: segment.values.iter().filter_map(named).collect(),
            clearances: Vec::new(),
        };
        let setups = segments.iter().map(setup).collect();
        let mut duty = Self { name: Some(mission.name.to_string()), setups };
        let mut sources = duty.sources(system, study.revolutions, Watch::NONE)?;
        let learnt = duty.setups.iter().zip(&mut sources).map(|(setup, source)| {
            let seconds = source.seconds_per_revolution().map_err(|error| match error {
                RunError::TurnsNotReached { .. } => Cause::Rests { segment: setup.name.clone() },
                error => duty.error(setup, error).into(),
            })?;
            Ok((seconds, source.unworn().iter().map(|joint| joint.clearance).collect()))
        });
        let learnt = learnt.collect::<Result<Vec<(Option<f64>, Vec<f64>)>, Cause>>()?;
        drop(sources);
        let first = learnt.first().map_or_else(Vec::new, |(_, clearances)| clearances.clone());
        for (setup, (seconds, clearances)) in duty.setups.iter_mut().zip(learnt) {
            setup.seconds = seconds;
            setup.clearances = clearances.iter().zip(&first).map(|(own, first)| own - first).collect();
        }
        duty.share_revolutions()?;
        Ok(duty)
    }

    /// Revolutions go by time over their length.
    fn share_revolutions(&mut self) -> Result<(), Cause> {
        if self.setups.len() == 1 {
            return Ok(());
        }
        let per_second = |setup: &Setup| {
            let uneven = || Cause::UnevenTurns { segment: setup.name.clone() };
            setup.seconds.map(|seconds| setup.time / seconds).ok_or_else(uneven)
        };
        let rates = self.setups.iter().map(per_second).collect::<Result<Vec<f64>, Cause>>()?;
        let all: f64 = rates.iter().sum();
        for (setup, rate) in self.setups.iter_mut().zip(rates) {
            setup.revolutions = rate / all;
        }
        Ok(())
    }

    /// How long a revolution lasts on average [s]; nothing where the revolutions of a single segment last differently.
    pub fn seconds_per_revolution(&self) -> Option<f64> {
        match &self.setups[..] {
            [alone] => alone.seconds,
            setups => {
                let rate = setups.iter().map(|setup| Some(setup.time / setup.seconds?)).sum::<Option<f64>>();
                rate.map(|rate| 1.0 / rate)
            }
        }
    }

    /// How long a mission lasts [s], where its segments have durations.
    pub fn seconds(&self) -> Option<f64> {
        self.setups.iter().map(|setup| setup.duration).sum()
    }

    /// Revolutions of every segment.
    pub fn sources<'s>(
        &'s self,
        system: &'s dyn System<f64>,
        settings: RevolutionSettings,
        between: Watch<'s>,
    ) -> Result<Vec<DynamicsSource<'s>>, MissionError<RunError>> {
        let source = |setup: &'s Setup| {
            let made = DynamicsSource::new(system, &setup.description, &setup.parameters, settings);
            made.map(|source| source.watched_by(between)).map_err(|error| self.error(setup, error))
        };
        self.setups.iter().map(source).collect()
    }

    /// What these sources, one for each segment, wear together.
    pub fn compose<F: WearSource>(&self, sources: Vec<F>) -> MissionSource<F> {
        let segment = |(setup, source): (&Setup, F)| MissionSegment {
            name: setup.name.clone(),
            source,
            revolutions: setup.revolutions,
            time: setup.time,
            clearances: setup.clearances.clone(),
        };
        MissionSource::new(self.setups.iter().zip(sources).map(segment).collect(), LEAST_TOUCHING)
    }

    fn error(&self, setup: &Setup, error: RunError) -> MissionError<RunError> {
        match self.name {
            Some(_) => MissionError::Segment { segment: setup.name.clone(), error },
            None => MissionError::Alone(error),
        }
    }
}
