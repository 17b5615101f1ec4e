"""Euro NCAP TB 038: the friction of a steering robot, measured by hand and checked against the bulletin's limits.

>>> import luztar
>>> luztar.tb038.rule_sets()
('TB 038 v1.0',)
"""

from __future__ import annotations

from .check import Check as Check
from .check import FilterUse as FilterUse
from .check import Outcome as Outcome
from .checklist import checklist as checklist
from .evaluate import evaluate as evaluate
from .once_per_turn import OncePerTurn as OncePerTurn
from .rules import CheckItem as CheckItem
from .rules import Judgement as Judgement
from .rules import RuleSet as RuleSet
from .rules import judge as judge
from .rules import load_rules as load_rules
from .rules import rule_set as rule_set
from .rules import rule_sets as rule_sets
from .verification import Verification as Verification
