//! The columns of a model: what each coefficient multiplies, filtered and decimated like the measurement.

use std::convert::Infallible;
use std::sync::Arc;

use super::cache::Key;
use super::contact::{Slide, slide};
use super::equations::{Blocks, Rows};
use super::recording::Recording;
use super::whitening::Whitening;
use crate::Error;
use crate::effects::{CATALOGUE, Channels, Contact, Effect, Kind, find};

/// After this many steps of the position sensor a start is no longer uncertain: the friction of a sharp break-away has
/// turned within twice its travel, which is at most two steps.
const STEPS_TO_BE_SURE: f64 = 4.0;

/// A start lies this many times what lies between the first two borders before the first: 1.4 times for constant
/// acceleration, 3.2 times for the fourth power of time, whose first twentieth moves nothing.
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
            for column in self.at_law_rate(effect, &term.inner, &contact)?.iter() {
                all.push(self.late(column, delay_s));
            }
        }
        Ok(all)
    }

    /// The normal equations of a model, one block per stroke.
    ///
    /// `given` are coefficients known beforehand, by the place of their column: these columns are not among those of
    /// the blocks, their part is taken off the measurement. `whitening` makes the noise white in both.
    ///
    /// # Errors
    /// As [`Recording::columns`]; [`Error::Length`] for a measurement that is not as long as the comparison.
    pub fn normal_equations(
        &self,
        terms: &[Term],
        given: &[(usize, f64)],
        effort: &[f64],
        strokes: &[Rows],
        whitening: Option<Whitening>,
    ) -> Result<Blocks, Error> {
        let every: Vec<usize> = (0..terms.len()).collect();
        let mut columns = self.columns(terms, &every)?;
        let mut shift = self.start_shift(terms)?;
        crate::error::require_same_length("effort", effort, "comparison", shift.len())?;
        let mut left = effort.to_vec();
        for (place, coefficient) in given {
            for (y, c) in left.iter_mut().zip(&columns[*place]) {
                *y -= coefficient * c;
            }
        }
        if let Some(whitening) = whitening {
            for series in columns.iter_mut().chain([&mut shift, &mut left]) {
                whitening.apply(series);
            }
        }
        let free = columns
            .iter()
            .enumerate()
            .filter(|(place, _)| given.iter().all(|(known, _)| known != place))
            .map(|(_, column)| column.as_slice());
        let all: Vec<&[f64]> = free.chain([shift.as_slice(), &left]).collect();
        Ok(Blocks::of(&all, strokes))
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

    /// The filtered columns of one effect, kept for the next model that has the same.
    fn at_law_rate(
        &self,
        effect: &Effect,
        inner: &[f64],
        contact: &Contact,
    ) -> Result<Arc<Vec<Vec<f64>>>, Error> {
        let friction = effect.card.kind == Kind::FrictionLevel;
        let behind = effect.card.behind_gap && contact.gap > 0.0;
        let key = Key::new(
            effect.card.name,
            inner,
            (friction || behind).then_some(contact),
        );
        self.columns_kept.get(key, || {
            let mut raw = (effect.along)(&self.channels(), inner);
            if friction {
                let slide = self.slide(contact);
                for column in &mut raw {
                    if !effect.at_rest {
                        slide.hold_at_rest(column);
                    }
                    multiply(column, &slide.state);
                }
            } else if behind && let Some(engaged) = &self.slide(contact).engaged {
                for column in &mut raw {
                    multiply(column, engaged);
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
        let filtered =
            self.columns_kept
                .get(Key::new("start shift", &[], Some(&contact)), || {
                    let slide = self.slide(&contact);
                    let mut near = vec![0.0; slide.rate.len()];
                    for stroke in self.strokes() {
                        let onset = self.law_sample(stroke.onset);
                        // The onset is the last sample at rest; the way into the first step begins before it.
                        let lead_s = START_LEAD * stroke.first_step_s;
                        let from =
                            onset.saturating_sub((lead_s * self.law_rate_hz).ceil() as usize);
                        let start = self.seen[onset];
                        let gone = |i: &usize| {
                            (self.seen[*i] - start).abs() > STEPS_TO_BE_SURE * self.resolution()
                        };
                        let to = (onset..near.len()).find(gone).unwrap_or(near.len());
                        for (near, rate) in near[from..to].iter_mut().zip(&slide.rate[from..to]) {
                            *near = rate * self.law_rate_hz;
                        }
                    }
                    Ok(vec![self.filtered(&near)?])
                })?;
        Ok(self.late(&filtered[0], delay_s))
    }

    /// What a contact does along the record, kept for the other effects that share it.
    fn slide(&self, contact: &Contact) -> Arc<Slide> {
        let made = self
            .slides_kept
            .get(Key::new("slide", &[], Some(contact)), || {
                Ok::<_, Infallible>(slide(contact, &self.seen))
            });
        match made {
            Ok(slide) => slide,
            Err(never) => match never {},
        }
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
            slowest_speed: self.slowest_speed,
            turn_rad_per_unit: self.turn_rad_per_unit,
            step_s: 1.0 / self.law_rate_hz,
        }
    }

    /// The kept samples of a column, read `delay_s` earlier.
    ///
    /// Cubic interpolation of a filtered column: its error is below `(2 pi band / rate)^4 / 43` of the amplitude, for a
    /// band of 6 Hz 5e-4 at 100 Hz and 3e-5 at 200 Hz.
    fn late(&self, column: &[f64], delay_s: f64) -> Vec<f64> {
        if delay_s == 0.0 {
            return column.iter().step_by(self.every()).copied().collect();
        }
        let last = column.len() - 1;
        let at = |i: isize| column[i.clamp(0, last.cast_signed()) as usize];
        (0..column.len())
            .step_by(self.every())
            .map(|k| {
                let place = (k as f64 - delay_s * self.law_rate_hz).clamp(0.0, last as f64);
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
