"""Models of a mechanism: a structure and the effects in it."""

from .cards import Card as Card
from .cards import Parameter as Parameter
from .cards import card as card
from .cards import cards as cards
from .cards import every_card as every_card
from .cards import find_card as find_card
from .file import load as load
from .model import Comparison as Comparison
from .model import Effect as Effect
from .model import Model as Model
from .structure import STRUCTURES as STRUCTURES
from .structure import Structure as Structure
