//! What there is to know about an effect besides its law: written once, shown by `luztar explain` and the report.

/// How an effect combines with the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A torque of its own; torques add.
    Torque,
    /// A part of the level of the contact's one friction state; levels add.
    FrictionLevel,
    /// A torque that depends on the angle alone.
    Spring,
    /// A change of what the mechanism passes on (freeplay).
    Transmission,
    /// A fault of the measurement (offset, drift, delay), not of the mechanism.
    Sensor,
    /// No physics at all: a ruler for what chance alone can explain.
    Decoy,
}

impl Kind {
    /// The word used in files and reports.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Torque => "torque",
            Self::FrictionLevel => "friction_level",
            Self::Spring => "spring",
            Self::Transmission => "transmission",
            Self::Sensor => "sensor",
            Self::Decoy => "decoy",
        }
    }
}

/// How the value of an inner parameter is searched before it is refined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Grid {
    /// Geometric, between the slowest speed the record resolves and its highest.
    Speed,
    /// Geometric, from half a resolution step of the position sensor up to a share of the range of motion.
    Travel {
        /// The largest value as a share of the range of motion.
        share_of_range: f64,
    },
    /// Geometric around the resolution of the position sensor: the sharpest break-away it can show.
    Resolution,
    /// Even, inside the range of motion.
    Place,
    /// Even, shares of the largest position on either side.
    Reach {
        /// The smallest share.
        low: f64,
        /// The largest share.
        high: f64,
    },
    /// Geometric, a share of the range of motion.
    Width,
    /// Geometric, between a few seconds and the longest record.
    Time,
    /// Geometric, around the rests between the strokes.
    Rest,
    /// Geometric, from a sample of the record to the upper bound, in seconds.
    Delay,
    /// The whole numbers between the bounds.
    Count,
    /// The two shapes of a break-away: 0 stop, 1 exponential.
    Shape,
    /// Not searched: this many waves over the range of motion.
    WavesPerRange(f64),
}

impl Grid {
    /// The word used by the search.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Travel { .. } => "travel",
            Self::Resolution => "resolution",
            Self::Place => "place",
            Self::Reach { .. } => "reach",
            Self::Width => "width",
            Self::Time => "time",
            Self::Rest => "rest",
            Self::Delay => "delay",
            Self::Count => "count",
            Self::Shape => "shape",
            Self::WavesPerRange(_) => "waves_per_range",
        }
    }

    /// The numbers that go with the word, 0 where there are none.
    #[must_use]
    pub const fn values(self) -> (f64, f64) {
        match self {
            Self::Travel { share_of_range } => (0.0, share_of_range),
            Self::Reach { low, high } => (low, high),
            Self::WavesPerRange(waves) => (waves, waves),
            _ => (0.0, 0.0),
        }
    }
}

/// How a parameter enters the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// The coefficient of one column of the basis.
    Linear,
    /// The length of the pair of columns (sine, cosine).
    Amplitude,
    /// The angle of the pair of columns (sine, cosine).
    Phase,
    /// Inside the law: found by profile.
    Inner(Grid),
}

/// One parameter of an effect. Keys carry the units of a rig; an axis reads n for nm and m for rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name with unit, as in JSON and model files.
    pub key: &'static str,
    /// The symbol in the equation.
    pub symbol: &'static str,
    /// What it is, in one phrase.
    pub meaning: &'static str,
    /// How it enters the law.
    pub role: Role,
    /// Lowest admissible value.
    pub low: f64,
    /// Highest admissible value.
    pub high: f64,
}

/// The card of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Card {
    /// The name in commands, files and JSON.
    pub name: &'static str,
    /// The name in a sentence.
    pub title: &'static str,
    /// How it combines.
    pub kind: Kind,
    /// Whether it sits behind the freeplay, so that nothing of it is felt inside the gap.
    pub behind_gap: bool,
    /// The law, in plain text.
    pub equation: &'static str,
    /// What it looks like in torque over angle, speed or time.
    pub look: &'static str,
    /// What it comes from in the workshop.
    pub cause: &'static str,
    /// What to check or change, with the step of TB 038 Annex I where there is one.
    pub check: &'static str,
    /// Typical size on a steering-robot rig, in words.
    pub typical: &'static str,
    /// Where the law comes from.
    pub source: &'static str,
    /// Its parameters: linear ones in the order of the basis, then inner ones.
    pub parameters: &'static [Parameter],
    /// The simpler effect it becomes at the low end of its first inner parameter, if any.
    pub becomes: Option<&'static str>,
    /// Whether the law counts turns, so that an axis needs its pitch.
    pub per_turn: bool,
    /// Which channel beside motion and effort the law looks at, if any.
    pub channel: Option<&'static str>,
    /// Which effect must be in the model for this one to make sense, if any.
    pub needs: Option<&'static str>,
    /// The structures on which a search tries it; empty for all of them. A model may hold it anywhere.
    pub structures: &'static [&'static str],
}
