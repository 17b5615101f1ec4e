//! What a law is: a basis that is linear in its coefficients once the inner parameters are given.

use super::card::Card;
use super::lane::Lane;

/// The state of motion that a law may look at. Position and speed are rad and rad/s on a rig, m and m/s on an axis.
#[derive(Debug, Clone, Copy)]
pub struct Motion<L> {
    /// Position.
    pub position: L,
    /// Speed.
    pub speed: L,
    /// Acceleration.
    pub acceleration: L,
    /// Angle of the turning part, rad: the position of a rig, `2 pi x / pitch` of an axis.
    pub turn_rad: L,
    /// Seconds since the start of the file.
    pub time_s: L,
    /// Seconds of rest before the present stroke.
    pub rest_s: L,
    /// Travel since the present stroke started, as a share of the range of motion.
    pub travelled: L,
    /// +1 while the position increases, -1 while it decreases, held at rest.
    pub direction: L,
    /// The slowest speed that the record resolves; at rest the mechanism is slower than this.
    pub slowest_speed: L,
    /// Load on the contact, N; 0 where the record has no such channel.
    pub load_n: L,
}

/// How quickly a contact forgets that it was at rest: e-folds per range of motion travelled. A quarter per cent of the
/// range, 0.3 degrees of 120.
const FORGOTTEN: f64 = 400.0;

impl<L: Lane> Motion<L> {
    /// What is left after break-away of the extra that a contact had at rest: 1 at break-away, 0 a little later.
    #[inline]
    pub fn left_of_rest(&self) -> L {
        (self.travelled * L::splat(-FORGOTTEN)).exp()
    }
}

/// The one friction state of a contact, as the effects of a model shape it.
///
/// The state is `s = luz(u, gap / 2) / breakaway` with the stop operator `u` of radius `breakaway + gap / 2`: without
/// a gap the elastic-plastic friction state, with one the friction behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Travel from rest to full friction.
    pub breakaway: f64,
    /// Whether the break-away follows Dahl's exponential instead of a straight line.
    pub exponential: bool,
    /// Full width of the gap in front of the friction.
    pub gap: f64,
}

/// The law of one effect. Written once, used by driven fits, time steps and batches.
pub trait Law {
    /// Everything there is to know besides the law.
    const CARD: Card;
    /// How many columns the basis has.
    const COLUMNS: usize;
    /// Whether the law changes the columns of other effects, through the contact or the delay.
    const SHAPES_OTHERS: bool = false;
    /// Whether a friction level belongs to the contact at rest: it takes effect at once. What depends on the motion does
    /// so as the contact slides.
    const AT_REST: bool = false;

    /// Writes the `COLUMNS` basis values for one state of motion.
    fn basis<L: Lane>(motion: &Motion<L>, inner: &[f64], out: &mut [L]);

    /// Shapes the friction state; most effects leave it alone.
    fn contact(_inner: &[f64], _contact: &mut Contact) {}

    /// By how many seconds the sensor is late; most effects say nothing about it.
    #[must_use]
    fn delay_s(_inner: &[f64]) -> f64 {
        0.0
    }
}

/// The states of motion along a record, one slice per channel, all of one length.
#[derive(Debug, Clone, Copy)]
pub struct Channels<'a> {
    /// See [`Motion::position`].
    pub position: &'a [f64],
    /// See [`Motion::speed`].
    pub speed: &'a [f64],
    /// See [`Motion::acceleration`].
    pub acceleration: &'a [f64],
    /// See [`Motion::rest_s`].
    pub rest_s: &'a [f64],
    /// See [`Motion::travelled`].
    pub travelled: &'a [f64],
    /// See [`Motion::direction`].
    pub direction: &'a [f64],
    /// See [`Motion::load_n`].
    pub load_n: Option<&'a [f64]>,
    /// See [`Motion::slowest_speed`].
    pub slowest_speed: f64,
    /// Radians of the turning part per unit of position.
    pub turn_rad_per_unit: f64,
    /// Seconds between samples.
    pub step_s: f64,
}

/// No law has more columns than a sine and a cosine.
const MOST_COLUMNS: usize = 2;

/// The basis of one law along a record, one vector per column; the law is known to the compiler, so that it is inlined.
fn along<T: Law>(channels: &Channels<'_>, inner: &[f64]) -> Vec<Vec<f64>> {
    let n = channels.position.len();
    let mut columns = vec![Vec::with_capacity(n); T::COLUMNS];
    for i in 0..n {
        let motion = Motion {
            position: channels.position[i],
            speed: channels.speed[i],
            acceleration: channels.acceleration[i],
            turn_rad: channels.position[i] * channels.turn_rad_per_unit,
            time_s: i as f64 * channels.step_s,
            rest_s: channels.rest_s[i],
            travelled: channels.travelled[i],
            direction: channels.direction[i],
            slowest_speed: channels.slowest_speed,
            load_n: channels.load_n.map_or(0.0, |load| load[i]),
        };
        let mut out = [0.0; MOST_COLUMNS];
        T::basis(&motion, inner, &mut out[..T::COLUMNS]);
        for (column, value) in columns.iter_mut().zip(out) {
            column.push(value);
        }
    }
    columns
}

/// An effect of the catalogue: a law behind function pointers, chosen by name at run time.
#[derive(Debug, Clone, Copy)]
pub struct Effect {
    /// Its card.
    pub card: &'static Card,
    /// How many columns the basis has.
    pub columns: usize,
    /// See [`Law::SHAPES_OTHERS`].
    pub shapes_others: bool,
    /// See [`Law::AT_REST`].
    pub at_rest: bool,
    /// The basis along a record.
    pub along: fn(&Channels<'_>, &[f64]) -> Vec<Vec<f64>>,
    /// See [`Law::contact`].
    pub contact: fn(&[f64], &mut Contact),
    /// See [`Law::delay_s`].
    pub delay_s: fn(&[f64]) -> f64,
}

impl Effect {
    /// The catalogue entry of a law.
    #[must_use]
    pub const fn of<T: Law>() -> Self {
        Self {
            card: &T::CARD,
            columns: T::COLUMNS,
            shapes_others: T::SHAPES_OTHERS,
            at_rest: T::AT_REST,
            along: along::<T>,
            contact: T::contact,
            delay_s: T::delay_s,
        }
    }

    /// How many inner parameters the law has.
    #[must_use]
    pub fn inner(&self) -> usize {
        self.card
            .parameters
            .iter()
            .filter(|p| matches!(p.role, super::card::Role::Inner(_)))
            .count()
    }
}
