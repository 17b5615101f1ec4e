//! The parameters of a car with its steering, their names and what values they take.

use crate::Error;

use super::table::parameters;

/// What values a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Domain {
    /// Above 0.
    Positive,
    /// 0 or above.
    NotNegative,
    /// Any finite number.
    Any,
}

parameters! {
    mass: "body.mass_kg", Positive;
    yaw_inertia: "body.yaw_inertia_kg_m2", Positive;
    front_axle: "body.front_axle_m", Positive;
    rear_axle: "body.rear_axle_m", Positive;
    front_end: "body.front_end_m", NotNegative;
    rear_end: "body.rear_end_m", NotNegative;
    width: "body.width_m", NotNegative;
    cg_height: "body.cg_height_m", NotNegative;
    sprung_mass: "body.sprung_mass_kg", NotNegative;
    roll_arm: "body.roll_arm_m", Any;
    roll_inertia: "body.roll_inertia_kg_m2", NotNegative;
    pitch_inertia: "body.pitch_inertia_kg_m2", NotNegative;
    wheel_radius: "body.wheel_radius_m", NotNegative;
    front_cornering: "front.cornering_n_per_rad", Positive;
    front_load_ratio: "front.load_ratio", NotNegative;
    front_friction: "front.friction", NotNegative;
    front_friction_load: "front.friction_load", NotNegative;
    front_shape: "front.shape", NotNegative;
    front_curvature: "front.curvature", Any;
    front_relaxation: "front.relaxation_m", NotNegative;
    front_pneumatic_trail: "front.pneumatic_trail_m", Any;
    front_caster_trail: "front.caster_trail_m", Any;
    front_roll_steer: "front.roll_steer", Any;
    front_track: "front.track_m", NotNegative;
    front_roll_stiffness: "front.roll_stiffness_nm_per_rad", NotNegative;
    front_roll_damping: "front.roll_damping_nm_s_per_rad", NotNegative;
    front_roll_centre: "front.roll_centre_m", Any;
    front_unsprung: "front.unsprung_kg", NotNegative;
    front_spring: "front.spring_n_per_m", NotNegative;
    front_tyre_stiffness: "front.tyre_stiffness_n_per_m", NotNegative;
    rear_cornering: "rear.cornering_n_per_rad", Positive;
    rear_load_ratio: "rear.load_ratio", NotNegative;
    rear_friction: "rear.friction", NotNegative;
    rear_friction_load: "rear.friction_load", NotNegative;
    rear_shape: "rear.shape", NotNegative;
    rear_curvature: "rear.curvature", Any;
    rear_relaxation: "rear.relaxation_m", NotNegative;
    rear_roll_steer: "rear.roll_steer", Any;
    rear_track: "rear.track_m", NotNegative;
    rear_roll_stiffness: "rear.roll_stiffness_nm_per_rad", NotNegative;
    rear_roll_damping: "rear.roll_damping_nm_s_per_rad", NotNegative;
    rear_roll_centre: "rear.roll_centre_m", Any;
    rear_unsprung: "rear.unsprung_kg", NotNegative;
    rear_spring: "rear.spring_n_per_m", NotNegative;
    rear_tyre_stiffness: "rear.tyre_stiffness_n_per_m", NotNegative;
    steering_inertia: "steering.inertia_kg_m2", Positive;
    steering_ratio: "steering.ratio", Positive;
    steering_stiffness: "steering.stiffness_nm_per_rad", Positive;
    steering_aligning: "steering.aligning_nm_per_rad", NotNegative;
    gap: "freeplay.gap_rad", NotNegative;
    viscous: "viscous.coefficient_nm_s_per_rad", NotNegative;
    coulomb: "coulomb.level_nm", NotNegative;
    stribeck: "stribeck.extra_nm", Any;
    stribeck_speed: "stribeck.speed_rad_s", NotNegative;
    stiction: "stiction.extra_nm", NotNegative;
    assist_gain: "assist.gain", Any;
    assist_threshold: "assist.threshold_nm", NotNegative;
    assist_second_gain: "assist.second_gain", Any;
    assist_second_threshold: "assist.second_threshold_nm", NotNegative;
    wheel_inertia: "handwheel.inertia_kg_m2", NotNegative;
    wheel_viscous: "handwheel.viscous_nm_s_per_rad", NotNegative;
    wheel_coulomb: "handwheel.coulomb_nm", NotNegative;
    wheel_stiction: "handwheel.stiction_nm", NotNegative;
    rear_steer: "rear.steer_ratio", Any;
    rear_steer_gap: "rear.steer_gap_rad", NotNegative;
}

impl Parameters {
    /// Reads the parameters in the order of [`NAMES`] and checks them.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`], naming the parameter.
    pub fn from_slice(values: &[f64]) -> Result<Self, Error> {
        if values.len() != NAMES.len() {
            return Err(Error::Length {
                name: "parameters",
                expected: format!("{}, one per name,", NAMES.len()),
                got: values.len(),
            });
        }
        for ((name, domain), &value) in NAMES.iter().zip(DOMAINS).zip(values) {
            if !value.is_finite() {
                return Err(Error::NonFinite {
                    name,
                    index: 0,
                    value,
                });
            }
            let fits = match domain {
                Domain::Positive => value > 0.0,
                Domain::NotNegative => value >= 0.0,
                Domain::Any => true,
            };
            if !fits {
                let interval = if *domain == Domain::Positive {
                    "(0, inf)"
                } else {
                    "[0, inf)"
                };
                return Err(out(name, value, interval));
            }
        }
        let car = Self::read(values);
        if car.stribeck < -car.coulomb {
            // Friction that drives the motion would be a source of energy.
            return Err(out(
                "stribeck.extra_nm",
                car.stribeck,
                "[-coulomb.level_nm, inf)",
            ));
        }
        if car.stribeck != 0.0 && car.stribeck_speed <= 0.0 {
            let interval = "(0, inf) with a stribeck.extra_nm";
            return Err(out("stribeck.speed_rad_s", car.stribeck_speed, interval));
        }
        if car.sprung_mass > car.mass {
            return Err(out(
                "body.sprung_mass_kg",
                car.sprung_mass,
                "[0, body.mass_kg]",
            ));
        }
        for (name, curvature) in [
            ("front.curvature", car.front_curvature),
            ("rear.curvature", car.rear_curvature),
        ] {
            if curvature > 1.0 {
                return Err(out(name, curvature, "(-inf, 1]"));
            }
        }
        Ok(car)
    }

    /// Refuses what a tyre law cannot do without.
    pub(super) fn require_grip(&self, magic: bool) -> Result<(), Error> {
        for (name, value) in [
            ("front.friction", self.front_friction),
            ("rear.friction", self.rear_friction),
        ] {
            if value <= 0.0 {
                return Err(out(name, value, "(0, inf) for a tyre that slides"));
            }
        }
        if magic {
            for (name, value) in [
                ("front.shape", self.front_shape),
                ("rear.shape", self.rear_shape),
            ] {
                // From 2 on the force would change its sign at large slip.
                if !(value > 0.0 && value < 2.0) {
                    return Err(out(name, value, "(0, 2) for the Magic Formula"));
                }
            }
        }
        Ok(())
    }
}

/// A value outside its interval.
pub(super) fn out(name: &'static str, value: f64, interval: &str) -> Error {
    Error::OutOfRange {
        name,
        value,
        interval: interval.to_owned(),
    }
}
