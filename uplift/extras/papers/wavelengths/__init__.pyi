from .choice import METHODS as METHODS
from .choice import Choice as Choice
from .choice import choose as choose
from .choice import choose_orders as choose_orders
from .choice import fit_weights as fit_weights
from .sampling import Sampling as Sampling
from .sampling import grid as grid
from .sampling import make_setup as make_setup
