"""Error against cost of ways to run a stick-slip trajectory: `python -m benches.work_precision`."""
