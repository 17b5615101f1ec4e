//! `luztar._core.effect_cards()`: the catalogue's cards as plain Python values.

use luztar::effects::{CATALOGUE, Effect, Role};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// One dict per effect, in the order of the catalogue.
#[pyfunction]
pub fn effect_cards(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    CATALOGUE.iter().map(|effect| card(py, effect)).collect()
}

fn card<'py>(py: Python<'py>, effect: &Effect) -> PyResult<Bound<'py, PyDict>> {
    let card = effect.card;
    let dict = PyDict::new(py);
    for (key, text) in [
        ("name", card.name),
        ("title", card.title),
        ("kind", card.kind.word()),
        ("equation", card.equation),
        ("look", card.look),
        ("cause", card.cause),
        ("check", card.check),
        ("typical", card.typical),
        ("source", card.source),
    ] {
        dict.set_item(key, text)?;
    }
    dict.set_item("behind_gap", card.behind_gap)?;
    dict.set_item("shapes_others", effect.shapes_others)?;
    dict.set_item("becomes", card.becomes)?;
    dict.set_item("channel", card.channel)?;
    dict.set_item("per_turn", card.per_turn)?;
    dict.set_item("needs", card.needs)?;
    dict.set_item("structures", card.structures.to_vec())?;
    let parameters = card
        .parameters
        .iter()
        .map(|p| {
            let dict = PyDict::new(py);
            dict.set_item("key", p.key)?;
            dict.set_item("symbol", p.symbol)?;
            dict.set_item("meaning", p.meaning)?;
            dict.set_item("low", p.low)?;
            dict.set_item("high", p.high)?;
            let (role, grid) = match p.role {
                Role::Linear => ("linear", None),
                Role::Amplitude => ("amplitude", None),
                Role::Phase => ("phase", None),
                Role::Inner(grid) => (
                    "inner",
                    Some((grid.word(), grid.values().0, grid.values().1)),
                ),
            };
            dict.set_item("role", role)?;
            dict.set_item("grid", grid)?;
            Ok(dict)
        })
        .collect::<PyResult<Vec<_>>>()?;
    dict.set_item("parameters", parameters)?;
    Ok(dict)
}
