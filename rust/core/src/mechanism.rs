//! Mechanisms of several bodies: what they consist of ([`Network`]), and how they move.
//!
//! Bodies with one coordinate each, and between them springs with freeplay, dampers, dry friction and assistance, seen
//! through ratios. One step ([`Stepper`]) has a bounded cost and allocates nothing; in stick the relative speed is
//! exactly 0. [`trace`] keeps everything that happens, [`simulate`] runs many parameter sets over all threads.

mod batch;
mod box_qp;
mod channels;
mod check;
mod contacts;
mod engine;
mod factor;
mod forces;
mod ledger;
mod moreau;
mod network;
mod rigid;
mod smooth;
mod stability;
mod stepper;
mod trace;

pub use batch::{Lanes, SUMMARY, simulate, summarise};
pub use box_qp::{BoxQp, Method, Outcome};
pub use channels::Channels;
pub use ledger::Ledger;
pub use network::{Body, Element, End, Law, Network, Node};
pub use stability::{LongestStep, longest_step};
pub use stepper::Stepper;
pub use trace::{Event, EventKind, Trace, trace};
