"""The list the engineer ticks before the readings: what no record can prove afterwards."""

from __future__ import annotations

from .rules import CheckItem, RuleSet, rule_set


def checklist(rules: str | RuleSet = "TB 038 v1.0") -> tuple[CheckItem, ...]:
    """Return the pre-check list of a rule set, in the order of the procedure.

    Parameters
    ----------
    rules : str or RuleSet

    Returns
    -------
    tuple of CheckItem
        ``step`` is the place in the bulletin, ``text`` what must be so.

    Examples
    --------
    >>> from luztar import tb038
    >>> tb038.checklist()[0].step
    'Annex I 1, 2.2.1'
    """
    return rule_set(rules).checklist


def as_text(items: tuple[CheckItem, ...]) -> str:
    """Return the list as plain text with a box before each line."""
    width = max((len(item.step) for item in items), default=0)
    return "\n".join(f"  [ ] {item.step:<{width}}  {item.text}" for item in items)


def as_html(items: tuple[CheckItem, ...]) -> str:
    """Return the list as an HTML list with a box to tick before each line."""
    from html import escape

    rows = "".join(
        f'<li><label><input type="checkbox"> {escape(item.text)} <small>{escape(item.step)}</small></label></li>'
        for item in items
    )
    return f'<ul class="checklist">{rows}</ul>'
