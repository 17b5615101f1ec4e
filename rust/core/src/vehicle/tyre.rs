//! Lateral force and self-aligning moment of a tyre, one text for every car model.
//!
//! Axes of ISO 8855: y to the left, slip positive where the wheel moves to its left, so that the force is negative
//! there. Slip is the tangent of the slip angle. The pneumatic trail of the curved laws is that of the brush model:
//! `t0 (1 - th)^3 / (1 - th + th^2/3)`, `th = K |slip| / (3 mu Fz)`; 0 where the whole contact slides.

use crate::dynamics::Pure;
use crate::effects::Lane;

use super::angle::{atan, sin};

/// What a tyre's law needs to know.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grip {
    /// Cornering stiffness, N/rad.
    pub stiffness: Pure,
    /// Largest lateral force, N.
    pub limit: Pure,
    /// Shape factor C of the Magic Formula.
    pub shape: Pure,
    /// 1 over it.
    pub inv_shape: Pure,
    /// Curvature factor E of the Magic Formula.
    pub curvature: Pure,
    /// Pneumatic trail at no slip, m.
    pub trail: Pure,
}

/// What a tyre puts on its wheel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// Lateral force, N, positive to the left.
    pub force: Pure,
    /// Force times pneumatic trail, Nm; it turns the wheel against it.
    pub moment: Pure,
}

/// A tyre's law.
pub(super) trait Tyre {
    /// Whether angles are taken as small: the car is then a linear system.
    const LINEAR: bool;

    /// Force and moment at a slip.
    fn contact(grip: &Grip, slip: Pure) -> Contact;
}

// Below this force (N) a wheel is in the air; it keeps the quotients finite.
const AIRBORNE: f64 = 1e-9;

/// Share of the contact that slides, at most 1.
#[inline(always)]
fn sliding(grip: &Grip, slip: Pure) -> Pure {
    let limit = grip.limit.clamp(Pure(AIRBORNE), Pure(f64::MAX));
    (grip.stiffness * slip.abs() / (limit * Pure(3.0))).clamp(Pure::ZERO, Pure::ONE)
}

/// Force proportional to slip, constant trail.
pub(super) struct Linear;

impl Tyre for Linear {
    const LINEAR: bool = true;

    #[inline(always)]
    fn contact(grip: &Grip, slip: Pure) -> Contact {
        let force = -(grip.stiffness * slip);
        Contact {
            force,
            moment: force * grip.trail,
        }
    }
}

/// Fiala's brush model: parabolic pressure, one coefficient of friction.
pub(super) struct Brush;

impl Tyre for Brush {
    const LINEAR: bool = false;

    #[inline(always)]
    fn contact(grip: &Grip, slip: Pure) -> Contact {
        let share = sliding(grip, slip);
        let left = Pure::ONE - share;
        let size = grip.limit * Pure(3.0) * share;
        let side = -slip.sign();
        Contact {
            force: side * size * (left + share * share * Pure(1.0 / 3.0)),
            moment: side * size * grip.trail * left * left * left,
        }
    }
}

/// Pacejka's `D sin(C atan(B s - E (B s - atan(B s))))` with `B = K / (C D)`.
pub(super) struct MagicFormula;

impl Tyre for MagicFormula {
    const LINEAR: bool = false;

    #[inline(always)]
    fn contact(grip: &Grip, slip: Pure) -> Contact {
        let limit = grip.limit.clamp(Pure(AIRBORNE), Pure(f64::MAX));
        let reach = grip.stiffness * slip / limit;
        let x = reach * grip.inv_shape;
        let bent = x - grip.curvature * (x - atan(x));
        let force = -(grip.limit * sin(grip.shape * atan(bent)));
        let share = (reach.abs() * Pure(1.0 / 3.0)).clamp(Pure::ZERO, Pure::ONE);
        let left = Pure::ONE - share;
        let trail = grip.trail * left * left * left / (left + share * share * Pure(1.0 / 3.0));
        Contact {
            force,
            moment: force * trail,
        }
    }
}
