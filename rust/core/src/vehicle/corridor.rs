//! The corridor: sections with straight edges, and how far the whole body stays from them.
//!
//! In a section the part of each side of the car that lies within it is compared with the edge on that side, at both
//! ends of that part: side and edge are straight, so that no point between them is nearer. Corners of the car and
//! corners of the section are thereby both covered. Distances run across the corridor (along y).

use crate::Error;
use crate::dynamics::Pure;
use crate::effects::Lane;

use super::columns::Views;
use super::fleet::Fleet;
use super::parameters::out;
use super::summary::Tally;

/// Numbers of a section: from and to (x), right edge at both, left edge at both (y), all in m.
pub const SECTION: usize = 6;

/// Sections, one set for all lanes or one per lane.
#[derive(Debug, Clone, Copy)]
pub struct Corridor<'a> {
    count: usize,
    values: &'a [f64],
}

impl<'a> Corridor<'a> {
    /// Sets of `count` sections of [`SECTION`] numbers.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`], [`Error::OutOfRange`] for a section that ends before it begins or whose
    /// left edge is not to the left.
    pub fn new(count: usize, values: &'a [f64]) -> Result<Self, Error> {
        if count == 0 || values.is_empty() || !values.len().is_multiple_of(count * SECTION) {
            return Err(Error::Length {
                name: "corridor",
                expected: "at least one section of 6".to_owned(),
                got: values.len(),
            });
        }
        crate::error::require_finite("corridor", values)?;
        let (sections, _) = values.as_chunks::<SECTION>();
        for &[from, to, right_from, right_to, left_from, left_to] in sections {
            if to <= from {
                let interval = format!("({from}, inf): a section ends after it begins");
                return Err(out("corridor end (m)", to, &interval));
            }
            for (right, left) in [(right_from, left_from), (right_to, left_to)] {
                if left <= right {
                    let interval = format!("({right}, inf): left of the right edge");
                    return Err(out("corridor left edge (m)", left, &interval));
                }
            }
        }
        Ok(Self { count, values })
    }

    /// The sets it has: 1, or one per lane.
    pub(super) fn sets(&self) -> usize {
        self.values.len() / (self.count * SECTION)
    }

    /// The sections of a block of lanes, lane beside lane.
    pub(super) fn lay_out<const N: usize>(&self, lanes: [usize; N]) -> Vec<[[f64; N]; SECTION]> {
        (0..self.count)
            .map(|section| {
                let mut rows = [[0.0; N]; SECTION];
                for lane in 0..N {
                    let set = if self.sets() == 1 { 0 } else { lanes[lane] };
                    let at = (set * self.count + section) * SECTION;
                    let here = &self.values[at..at + SECTION];
                    let (length, right, left) = (here[1] - here[0], here[2], here[4]);
                    rows[0][lane] = here[0];
                    rows[1][lane] = here[1];
                    rows[2][lane] = right;
                    rows[3][lane] = (here[3] - right) / length;
                    rows[4][lane] = left;
                    rows[5][lane] = (here[5] - left) / length;
                }
                rows
            })
            .collect()
    }
}

/// Outline and place of a car in the plane.
#[derive(Debug, Clone, Copy)]
struct Outline {
    /// Reference point, m.
    pub x: Pure,
    /// See `x`.
    pub y: Pure,
    /// Sine of the yaw angle.
    pub sin: Pure,
    /// Cosine of the yaw angle.
    pub cos: Pure,
    /// From the reference point to the front and to the rear end, m.
    pub front: Pure,
    /// See `front`.
    pub rear: Pure,
    /// Half width, m.
    pub half_width: Pure,
}

// A car that turns further than 84 degrees out of the corridor's direction is measured as if it had turned that far.
const LEAST_COS: f64 = 0.1;
/// Clearance where no section is reached.
pub(super) const FREE: f64 = f64::INFINITY;

/// The corridor of a block of lanes, and the cars' outlines.
pub(super) struct Course<const N: usize> {
    sections: Vec<[[f64; N]; SECTION]>,
    front: [f64; N],
    rear: [f64; N],
    half_width: [f64; N],
}

impl<const N: usize> Course<N> {
    /// Of these lanes.
    pub fn of(fleet: &Fleet<'_>, of: [usize; N]) -> Self {
        Self {
            sections: fleet.corridor.map_or_else(Vec::new, |c| c.lay_out(of)),
            front: of.map(|lane| fleet.cars[lane].front_end),
            rear: of.map(|lane| fleet.cars[lane].rear_end),
            half_width: of.map(|lane| 0.5 * fleet.cars[lane].width),
        }
    }

    /// Compares every car with every section, in the middle of a step.
    #[inline(always)]
    pub fn measure(&self, seen: &Views<N>, tally: &mut Tally<N>) {
        if self.sections.is_empty() {
            return;
        }
        let mut least = [FREE; N];
        for section in &self.sections {
            for lane in 0..N {
                let outline = Outline {
                    x: Pure(seen.x[lane]),
                    y: Pure(seen.y[lane]),
                    sin: Pure(seen.sin[lane]),
                    cos: Pure(seen.cos[lane]),
                    front: Pure(self.front[lane]),
                    rear: Pure(self.rear[lane]),
                    half_width: Pure(self.half_width[lane]),
                };
                let (left, right) = clearance(section, lane, &outline);
                let counts = seen.weight[lane] > 0.0;
                let lesser =
                    |kept: f64, value: Pure| value.when(counts & (value.0 < kept), Pure(kept)).0;
                tally.left[lane] = lesser(tally.left[lane], left);
                tally.right[lane] = lesser(tally.right[lane], right);
                least[lane] = lesser(lesser(least[lane], left), right);
            }
        }
        for lane in 0..N {
            let over = Pure(-least[lane]).when(least[lane] < 0.0, Pure::ZERO);
            tally.outside[lane] += (over * Pure(seen.weight[lane])).0;
        }
    }
}

/// The least distance of the left and of the right side from the edges of one section; [`FREE`] outside it.
#[inline(always)]
fn clearance<const N: usize>(
    section: &[[f64; N]; SECTION],
    lane: usize,
    car: &Outline,
) -> (Pure, Pure) {
    let of = |row: usize| Pure(section[row][lane]);
    let cos = car.cos.clamp(Pure(LEAST_COS), Pure::ONE);
    let slope = car.sin / cos;
    let side = |way: Pure, edge: Pure, edge_slope: Pure| {
        let x = car.x - way * car.half_width * car.sin;
        let y = car.y + way * car.half_width * cos;
        let from = x - car.rear * cos;
        let to = x + car.front * cos;
        let low = of(0).when(of(0).0 > from.0, from);
        let high = of(1).when(of(1).0 < to.0, to);
        let gap = |at: Pure| way * (edge + edge_slope * (at - of(0)) - (y + slope * (at - x)));
        let (a, b) = (gap(low), gap(high));
        a.when(a.0 < b.0, b).when(low.0 <= high.0, Pure(FREE))
    };
    (
        side(Pure::ONE, of(4), of(5)),
        side(-Pure::ONE, of(2), of(3)),
    )
}
