"""Least squares: lines, polynomials, several predictors; at once or pushed, merged, fading, over a window, robust."""

from .line import Line as Line
from .line import LineSums as LineSums
from .line import RollingLine as RollingLine
from .line import TimeLine as TimeLine
from .line import line as line
from .line import time_line as time_line
from .linear import LinearFit as LinearFit
from .linear import LinearSums as LinearSums
from .linear import linear as linear
from .polynomial import PolynomialFit as PolynomialFit
from .polynomial import PolynomialSums as PolynomialSums
from .polynomial import RollingPolynomial as RollingPolynomial
from .polynomial import polynomial as polynomial
from .recursive import RecursiveLeastSquares as RecursiveLeastSquares
from .robust import HuberFit as HuberFit
from .robust import TheilSenLine as TheilSenLine
from .robust import huber as huber
from .robust import theil_sen as theil_sen
