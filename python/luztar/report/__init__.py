"""Figures of results, and the report: one self-contained HTML file."""

from __future__ import annotations

from .write import write_report as write_report
