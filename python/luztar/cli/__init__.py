"""The command line: ``luztar study run*.csv --model rig``.

Importing this package loads nothing; ``main`` is the console script.
"""

from .entry import main as main
