"""Calibration: how often the study names what an independent generator has hidden, and what it says where nothing is.

`python -m benches.hidden_effects --help`
"""
