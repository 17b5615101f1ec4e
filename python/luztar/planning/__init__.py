"""Plan a test before anybody turns a wheel, and the test to do next where a measurement does not decide."""

from .plan import Plan as Plan
from .plan import plan as plan
