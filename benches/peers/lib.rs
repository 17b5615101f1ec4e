//! Nothing but benches: see `benches/filters.rs`.
