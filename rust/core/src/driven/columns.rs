//! The columns of a model: what each coefficient multiplies, filtered and decimated like the measurement.

use super::cache::{Columns, Key};
use super::contact::{engagement, friction_state, hold_at_rest};
use super::kinematics::derivative;
use super::recording::Recording;
use crate::Error;
use crate::effects::{CATALOGUE, Channels, Contact, Effect, Kind, find};

/// After this many steps of the position sensor a start is no longer uncertain: the friction of a sharp break-away has
/// turned within twice its travel, which is at most two steps.
const STEPS_TO_BE_SURE: f64 = 4.0;

/// The parabola into the first border takes this many times what lies between the first two, which is twice the
/// uncertainty of an onset; doubled for starts that are gentler than that.
const START_LEAD: f64 = 3.0;

/// One effect of a model with the values of its inner parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// The effect's name.
    pub effect: String,
    /// Its inner parameters, in the order of its card.
    pub inner: Vec<f64>,
}

/// Looks a term's effect up and checks the number and sign of its inner parameters.
///
/// # Errors
/// [`Error::Unknown`], [`Error::Length`] or [`Error::NonFinite`].
pub fn inner_of(term: &Term) -> Result<&'static Effect, Error> {
    let effect = find(&term.effect)?;
    if term.inner.len() != effect.inner() {
        return Err(Error::Length {
            name: "inner",
            expected: format!("{} for {}", effect.inner(), term.effect),
            got: term.inner.len(),
        });
    }
    crate::error::require_finite("inner", &term.inner)?;
    Ok(effect)
}

impl Recording {
    /// The friction contact that the terms describe together, and the delay of the sensor.
    ///
    /// Effects shape the contact in the order of the catalogue, so that presliding replaces the sharp break-away of
    /// Coulomb friction whatever the order of the terms.
    fn contact(&self, terms: &[Term]) -> Result<(Contact, f64), Error> {
        let mut contact = Contact {
            breakaway: 0.5 * self.resolution(),
            exponential: false,
            gap: 0.0,
        };
        let mut delay_s = 0.0;
        let mut sorted = terms
            .iter()
            .map(|t| Ok((inner_of(t)?, t)))
            .collect::<Result<Vec<_>, Error>>()?;
        sorted.sort_by_key(|(e, _)| CATALOGUE.iter().position(|c| c.card.name == e.card.name));
        for (effect, term) in sorted {
            (effect.contact)(&term.inner, &mut contact);
            delay_s += (effect.delay_s)(&term.inner);
        }
        for (name, value) in [("breakaway", contact.breakaway), ("gap", contact.gap)] {
            if value < 0.0 {
                return Err(Error::OutOfRange {
                    name,
                    value,
                    interval: "[0, inf)".into(),
                });
            }
        }
        // Half a step is the sharpest corner the sensor can show; a smaller one would only follow its flutter.
        contact.breakaway = contact.breakaway.max(1e-6 * self.resolution());
        Ok((contact, delay_s))
    }

    /// The friction state of a model at the samples that the comparison keeps, not filtered.
    ///
    /// # Errors
    /// As [`Recording::columns`].
    pub fn state(&self, terms: &[Term]) -> Result<Vec<f64>, Error> {
        let (contact, _) = self.contact(terms)?;
        Ok(friction_state(&contact, &self.seen)
            .into_iter()
            .step_by(self.decimate())
            .collect())
    }

    /// The columns of `wanted`, a choice of indices into `terms`; the other terms only shape contact and delay.
    ///
    /// # Errors
    /// [`Error::Unknown`] for an effect, [`Error::Length`] for its inner parameters, [`Error::OutOfRange`] for a
    /// negative gap or break-away.
    pub fn columns(&self, terms: &[Term], wanted: &[usize]) -> Result<Vec<Vec<f64>>, Error> {
        let (contact, delay_s) = self.contact(terms)?;
        let mut all = Vec::new();
        for index in wanted {
            let term = terms.get(*index).ok_or_else(|| Error::OutOfRange {
                name: "wanted",
                value: *index as f64,
                interval: format!("[0, {})", terms.len()),
            })?;
            let effect = inner_of(term)?;
            self.can_make(effect)?;
            for column in self.full_rate(effect, &term.inner, &contact)?.iter() {
                all.push(self.late(column, delay_s));
            }
        }
        Ok(all)
    }

    /// Whether the run holds what the law looks at.
    fn can_make(&self, effect: &Effect) -> Result<(), Error> {
        let missing = |what, known: &str| {
            let name = effect.card.name.to_owned();
            Err(Error::Unknown {
                what,
                name,
                known: known.to_owned(),
            })
        };
        if effect.card.per_turn && self.turn_rad_per_unit.is_nan() {
            return missing("turn of", "give the pitch");
        }
        if effect.card.channel.is_some() && self.load_n.is_none() {
            return missing("channel of", "record the load");
        }
        Ok(())
    }

    /// The filtered columns of one effect at full rate, kept for the next model that has the same.
    fn full_rate(
        &self,
        effect: &Effect,
        inner: &[f64],
        contact: &Contact,
    ) -> Result<Columns, Error> {
        let friction = effect.card.kind == Kind::FrictionLevel;
        let behind = effect.card.behind_gap && contact.gap > 0.0;
        let key = Key::new(
            effect.card.name,
            inner,
            (friction || behind).then_some(contact),
        );
        self.cache.get(key, || {
            let mut raw = (effect.along)(&self.channels(), inner);
            if friction || behind {
                let state = friction_state(contact, &self.seen);
                if friction {
                    for column in &mut raw {
                        hold_at_rest(column, contact, &self.seen);
                        multiply(column, &state);
                    }
                } else if let Some(engaged) = engagement(contact, &state) {
                    for column in &mut raw {
                        multiply(column, &engaged);
                    }
                }
            }
            raw.iter().map(|column| self.filtered(column)).collect()
        })
    }

    /// What a shift of every start in time would add, per second of shift and unit of friction level.
    ///
    /// The instant a motion starts is known to a step of the sensor only; the fit carries one such shift per stroke.
    /// The column holds the rate of the friction state from a stroke's onset until the motion has run through a few
    /// steps; from there on the sensor knows where it is.
    ///
    /// # Errors
    /// As [`Recording::columns`].
    pub fn start_shift(&self, terms: &[Term]) -> Result<Vec<f64>, Error> {
        let (contact, delay_s) = self.contact(terms)?;
        let filtered = self
            .cache
            .get(Key::new("start shift", &[], Some(&contact)), || {
                let rate = derivative(&friction_state(&contact, &self.seen), self.sample_rate_hz);
                let mut near = vec![0.0; rate.len()];
                for stroke in self.strokes() {
                    // The onset is the last sample at rest; the parabola into the first step begins before it.
                    let lead_s = 2.0 * START_LEAD * stroke.onset_uncertainty_s;
                    let from = stroke
                        .onset
                        .saturating_sub((lead_s * self.sample_rate_hz).ceil() as usize);
                    let start = self.seen[stroke.onset];
                    let gone = |i: &usize| {
                        (self.seen[*i] - start).abs() > STEPS_TO_BE_SURE * self.resolution()
                    };
                    let to = (stroke.onset..rate.len()).find(gone).unwrap_or(rate.len());
                    near[from..to].copy_from_slice(&rate[from..to]);
                }
                Ok(vec![self.filtered(&near)?])
            })?;
        Ok(self.late(&filtered[0], delay_s))
    }

    /// What laws look at, along the record.
    fn channels(&self) -> Channels<'_> {
        Channels {
            position: &self.position,
            speed: &self.speed,
            acceleration: &self.acceleration,
            rest_s: &self.phases.rest_s,
            travelled: &self.phases.travelled,
            direction: &self.phases.direction,
            load_n: self.load_n.as_deref(),
            slowest_speed: self.slowest_speed(),
            turn_rad_per_unit: self.turn_rad_per_unit,
            step_s: 1.0 / self.sample_rate_hz,
        }
    }

    /// The kept samples of a full-rate column, read `delay_s` earlier.
    ///
    /// Cubic interpolation of a filtered column: its error is below `(2 pi band / rate)^4 / 43` of the amplitude, for a
    /// band of 6 Hz 5e-4 at 100 Hz and 1e-6 at 500 Hz.
    fn late(&self, column: &[f64], delay_s: f64) -> Vec<f64> {
        if delay_s == 0.0 {
            return column.iter().step_by(self.decimate()).copied().collect();
        }
        let last = column.len() - 1;
        let at = |i: isize| column[i.clamp(0, last.cast_signed()) as usize];
        (0..column.len())
            .step_by(self.decimate())
            .map(|k| {
                let place = (k as f64 - delay_s * self.sample_rate_hz).clamp(0.0, last as f64);
                let i = place.floor() as isize;
                let f = place - i as f64;
                let (a, b, c, d) = (at(i - 1), at(i), at(i + 1), at(i + 2));
                // Lagrange's cubic through the four neighbours
                -f * (f - 1.0) * (f - 2.0) / 6.0 * a + (f + 1.0) * (f - 1.0) * (f - 2.0) / 2.0 * b
                    - (f + 1.0) * f * (f - 2.0) / 2.0 * c
                    + (f + 1.0) * f * (f - 1.0) / 6.0 * d
            })
            .collect()
    }
}

fn multiply(column: &mut [f64], by: &[f64]) {
    column.iter_mut().zip(by).for_each(|(c, b)| *c *= b);
}
