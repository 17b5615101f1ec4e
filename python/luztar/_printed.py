"""How results print themselves: rows of a name and a value, as text and as a table of a notebook."""

from __future__ import annotations

from html import escape

_WIDTH = 17


class Printed:
    """Prints the rows that a result gives by ``_rows()``."""

    __slots__ = ()

    def _rows(self) -> list[tuple[str, str]]:
        raise NotImplementedError

    def __str__(self) -> str:
        return "\n".join(f"{name:<{_WIDTH}}{value}" for name, value in self._rows())

    def _repr_html_(self) -> str:
        rows = (f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in self._rows())
        return f"<table>{''.join(rows)}</table>"


def with_error(value: float, error: float | None) -> str:
    """Return a value and, where it is known, its standard error."""
    return f"{value:.9g}" if error is None else f"{value:.9g} +- {error:.3g}"


def known(value: float | None) -> str:
    """Return a value, or the word that it is not known."""
    return "unknown" if value is None else f"{value:.6g}"
