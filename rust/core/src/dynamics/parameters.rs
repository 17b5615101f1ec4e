//! The parameters of a body by name: read, checked, laid out in a row.

use crate::Error;
use crate::effects::Lane;

use super::bristle::Bristle;
use super::ground::Ground;
use super::level::Level;
use super::number::Pure;
use super::one_mass::OneMass;
use super::{bristle, ground, level};

/// Values of the body without what stands in parts of its own.
const OWN: usize = 14;

/// How many parameters a body has, and how many values a row.
pub const PARAMETERS: usize = OWN + ground::VALUES + level::VALUES + bristle::VALUES;

/// What a value may be on its own.
#[derive(Clone, Copy)]
enum Sign {
    Positive,
    NotNegative,
    Any,
}

use Sign::{Any, NotNegative, Positive};

/// Every parameter with what it may be.
const TABLE: [(&str, Sign); PARAMETERS] = [
    ("inertia_kg_m2", Positive),
    ("ratio", Positive),
    ("stiffness_nm_per_rad", NotNegative),
    ("aligning_nm_per_rad", NotNegative),
    ("gap_rad", NotNegative),
    ("hardening_nm_per_rad3", Any),
    ("viscous_nm_s_per_rad", NotNegative),
    ("asymmetric_viscous_nm_s_per_rad", Any),
    ("drag_nm_s2_per_rad2", NotNegative),
    ("coulomb_nm", NotNegative),
    ("asymmetric_coulomb_nm", Any),
    ("stribeck_nm", Any),
    ("stribeck_speed_rad_s", NotNegative),
    ("stiction_nm", Any),
    ("end_stop_nm_per_rad", NotNegative),
    ("end_stop_limit_rad", NotNegative),
    ("dead_zone_nm_per_rad", Any),
    ("dead_zone_half_width_rad", NotNegative),
    ("once_per_rev_nm", Any),
    ("once_per_rev_phase_rad", Any),
    ("twice_per_rev_nm", Any),
    ("twice_per_rev_phase_rad", Any),
    ("cogging_nm", Any),
    ("cogging_phase_rad", Any),
    ("cogging_per_turn", NotNegative),
    ("position_coulomb_nm_per_rad", Any),
    ("tight_spot_nm", Any),
    ("tight_spot_angle_rad", Any),
    ("tight_spot_width_rad", NotNegative),
    ("load_coefficient", NotNegative),
    ("dwell_nm", NotNegative),
    ("dwell_time_s", NotNegative),
    ("presliding_breakaway_rad", NotNegative),
    ("presliding_shape", NotNegative),
    ("lugre_breakaway_rad", NotNegative),
    ("lugre_damping_nm_s_per_rad", NotNegative),
];

/// The names of the parameters, in the order of [`OneMass::from_array`].
pub const NAMES: [&str; PARAMETERS] = {
    let mut names = [""; PARAMETERS];
    let mut i = 0;
    while i < PARAMETERS {
        names[i] = TABLE[i].0;
        i += 1;
    }
    names
};

/// A size and the parameter by which it is divided: needed as soon as there is a size.
const DIVISORS: [(usize, usize, &str); 4] = [
    (
        place("stribeck_nm"),
        place("stribeck_speed_rad_s"),
        "(0, inf) with a stribeck_nm",
    ),
    (
        place("tight_spot_nm"),
        place("tight_spot_width_rad"),
        "(0, inf) with a tight_spot_nm",
    ),
    (
        place("dwell_nm"),
        place("dwell_time_s"),
        "(0, inf) with a dwell_nm",
    ),
    (
        place("cogging_nm"),
        place("cogging_per_turn"),
        "(0, inf) with a cogging_nm",
    ),
];

/// The place of a name; a name that is not there does not compile.
const fn place(name: &str) -> usize {
    let name = name.as_bytes();
    let mut i = 0;
    while i < PARAMETERS {
        let here = TABLE[i].0.as_bytes();
        let mut k = 0;
        while k < here.len() && k < name.len() && here[k] == name[k] {
            k += 1;
        }
        if k == here.len() && k == name.len() {
            return i;
        }
        i += 1;
    }
    panic!("no such parameter")
}

/// The value of a parameter by its name, looked up by the compiler.
macro_rules! of {
    ($values:expr, $name:literal) => {
        $values[const { place($name) }]
    };
}

fn out(name: &'static str, value: f64, interval: &str) -> Error {
    Error::OutOfRange {
        name,
        value,
        interval: interval.to_owned(),
    }
}

impl OneMass<f64> {
    /// Reads the parameters in the order of [`NAMES`] and checks them.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`], naming the parameter.
    pub fn from_array(values: &[f64; PARAMETERS]) -> Result<Self, Error> {
        check_each(values)?;
        check_friction(values)?;
        check_contact(values)?;
        // Without a size what divides says nothing, and 0 would divide.
        let divisor = |value: f64| if value > 0.0 { value } else { 1.0 };
        // One sine and cosine on every machine.
        let wave = |size: f64, phase: f64| [size * Pure(phase).cos().0, size * Pure(phase).sin().0];
        let travel =
            of!(values, "presliding_breakaway_rad").max(of!(values, "lugre_breakaway_rad"));
        let flag = |yes: bool| f64::from(u8::from(yes));
        Ok(Self {
            inertia: of!(values, "inertia_kg_m2"),
            ratio: of!(values, "ratio"),
            stiffness: of!(values, "stiffness_nm_per_rad"),
            aligning: of!(values, "aligning_nm_per_rad"),
            gap: of!(values, "gap_rad"),
            hardening: of!(values, "hardening_nm_per_rad3"),
            viscous: of!(values, "viscous_nm_s_per_rad"),
            asymmetric_viscous: of!(values, "asymmetric_viscous_nm_s_per_rad"),
            drag: of!(values, "drag_nm_s2_per_rad2"),
            coulomb: of!(values, "coulomb_nm"),
            asymmetric_coulomb: of!(values, "asymmetric_coulomb_nm"),
            stribeck: of!(values, "stribeck_nm"),
            stribeck_speed: divisor(of!(values, "stribeck_speed_rad_s")),
            stiction: of!(values, "stiction_nm"),
            ground: Ground {
                end_stop: [
                    of!(values, "end_stop_nm_per_rad"),
                    of!(values, "end_stop_limit_rad"),
                ],
                dead_zone: [
                    of!(values, "dead_zone_nm_per_rad"),
                    of!(values, "dead_zone_half_width_rad"),
                ],
                once: wave(
                    of!(values, "once_per_rev_nm"),
                    of!(values, "once_per_rev_phase_rad"),
                ),
                twice: wave(
                    of!(values, "twice_per_rev_nm"),
                    of!(values, "twice_per_rev_phase_rad"),
                ),
                cogging: wave(of!(values, "cogging_nm"), of!(values, "cogging_phase_rad")),
                per_turn: divisor(of!(values, "cogging_per_turn")),
            },
            level: Level {
                slope: of!(values, "position_coulomb_nm_per_rad"),
                tight_spot: [
                    of!(values, "tight_spot_nm"),
                    of!(values, "tight_spot_angle_rad"),
                    divisor(of!(values, "tight_spot_width_rad")),
                ],
                load: of!(values, "load_coefficient"),
                dwell: [
                    of!(values, "dwell_nm"),
                    divisor(of!(values, "dwell_time_s")),
                ],
            },
            bristle: Bristle {
                per_travel: if travel > 0.0 { 1.0 / travel } else { 0.0 },
                exponential: flag(of!(values, "presliding_shape") > 0.5),
                lugre: flag(of!(values, "lugre_breakaway_rad") > 0.0),
                damping: of!(values, "lugre_damping_nm_s_per_rad"),
            },
        })
    }

    /// The values of a row, as `gather` takes them: what divides is no longer 0, waves are sine and cosine.
    #[must_use]
    pub fn to_array(&self) -> [f64; PARAMETERS] {
        let mut row = [0.0; PARAMETERS];
        let own: [f64; OWN] = [
            self.inertia,
            self.ratio,
            self.stiffness,
            self.aligning,
            self.gap,
            self.hardening,
            self.viscous,
            self.asymmetric_viscous,
            self.drag,
            self.coulomb,
            self.asymmetric_coulomb,
            self.stribeck,
            self.stribeck_speed,
            self.stiction,
        ];
        let parts = own
            .into_iter()
            .chain(self.ground.to_values())
            .chain(self.level.to_values())
            .chain(self.bristle.to_values());
        for (place, value) in row.iter_mut().zip(parts) {
            *place = value;
        }
        row
    }

    /// The same body as the step takes it.
    #[must_use]
    pub fn pure(&self) -> OneMass<Pure> {
        let values = self.to_array();
        OneMass::gather(&values.map(|v| [v]), 0)
    }
}

impl OneMass<Pure> {
    /// One lane of a table of rows.
    #[inline(always)]
    pub(super) fn gather<const N: usize>(table: &[[f64; N]; PARAMETERS], lane: usize) -> Self {
        let of = |row: usize| Pure(table[row][lane]);
        let after = |first: usize| move |row: usize| Pure(table[first + row][lane]);
        Self {
            inertia: of(0),
            ratio: of(1),
            stiffness: of(2),
            aligning: of(3),
            gap: of(4),
            hardening: of(5),
            viscous: of(6),
            asymmetric_viscous: of(7),
            drag: of(8),
            coulomb: of(9),
            asymmetric_coulomb: of(10),
            stribeck: of(11),
            stribeck_speed: of(12),
            stiction: of(13),
            ground: Ground::from_values(after(OWN)),
            level: Level::from_values(after(OWN + ground::VALUES)),
            bristle: Bristle::from_values(after(OWN + ground::VALUES + level::VALUES)),
        }
    }
}

fn check_each(values: &[f64; PARAMETERS]) -> Result<(), Error> {
    for ((name, sign), value) in TABLE.into_iter().zip(*values) {
        if !value.is_finite() {
            return Err(Error::NonFinite {
                name,
                index: 0,
                value,
            });
        }
        match sign {
            Positive if value <= 0.0 => return Err(out(name, value, "(0, inf)")),
            NotNegative if value < 0.0 => return Err(out(name, value, "[0, inf)")),
            _ => {}
        }
    }
    for (size, divisor, interval) in DIVISORS {
        if values[size] != 0.0 && values[divisor] <= 0.0 {
            return Err(out(NAMES[divisor], values[divisor], interval));
        }
    }
    Ok(())
}

/// Friction that drives the motion would be a source of energy.
fn check_friction(values: &[f64; PARAMETERS]) -> Result<(), Error> {
    let (coulomb, asymmetric) = (
        of!(values, "coulomb_nm"),
        of!(values, "asymmetric_coulomb_nm"),
    );
    if asymmetric.abs() > coulomb {
        let interval = "[-coulomb_nm, coulomb_nm]";
        return Err(out("asymmetric_coulomb_nm", asymmetric, interval));
    }
    let (viscous, one_sided) = (
        of!(values, "viscous_nm_s_per_rad"),
        of!(values, "asymmetric_viscous_nm_s_per_rad"),
    );
    if one_sided.abs() > viscous {
        let interval = "[-viscous_nm_s_per_rad, viscous_nm_s_per_rad]";
        return Err(out("asymmetric_viscous_nm_s_per_rad", one_sided, interval));
    }
    let least = coulomb - asymmetric.abs();
    if of!(values, "stribeck_nm") < -least {
        return Err(out(
            "stribeck_nm",
            of!(values, "stribeck_nm"),
            "[-coulomb_nm, inf)",
        ));
    }
    if of!(values, "tight_spot_nm") < -(least + of!(values, "stribeck_nm").min(0.0)) {
        let interval = "[-coulomb_nm, inf)";
        return Err(out("tight_spot_nm", of!(values, "tight_spot_nm"), interval));
    }
    if of!(values, "stiction_nm") < 0.0 {
        let interval = "[0, inf): static friction is at least kinetic friction";
        return Err(out("stiction_nm", of!(values, "stiction_nm"), interval));
    }
    Ok(())
}

/// What an elastic contact cannot be together with.
fn check_contact(values: &[f64; PARAMETERS]) -> Result<(), Error> {
    let (presliding, lugre) = (
        of!(values, "presliding_breakaway_rad"),
        of!(values, "lugre_breakaway_rad"),
    );
    if of!(values, "presliding_shape") > 1.0 {
        let interval = "[0, 1]: 0 straight (stop), 1 exponential (Dahl)";
        return Err(out(
            "presliding_shape",
            of!(values, "presliding_shape"),
            interval,
        ));
    }
    if presliding > 0.0 && lugre > 0.0 {
        let interval = "{0} with a presliding_breakaway_rad: a contact has one law";
        return Err(out("lugre_breakaway_rad", lugre, interval));
    }
    if lugre > 0.0 && of!(values, "coulomb_nm") <= 0.0 {
        let interval = "(0, inf) with a lugre_breakaway_rad";
        return Err(out("coulomb_nm", of!(values, "coulomb_nm"), interval));
    }
    if presliding > 0.0 || lugre > 0.0 {
        for at_rest in const { [place("stiction_nm"), place("dwell_nm")] } {
            if values[at_rest] != 0.0 {
                let interval = "{0} on an elastic contact, which is never at rest: take stribeck";
                return Err(out(NAMES[at_rest], values[at_rest], interval));
            }
        }
    }
    Ok(())
}
