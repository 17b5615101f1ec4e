"""Simulated rig and axis measurements with a known hidden effect, sharing no code with luztar."""
