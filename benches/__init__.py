"""Measurements of luztar itself: how long it takes, how often it is right."""
