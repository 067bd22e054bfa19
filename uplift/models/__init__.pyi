from .model import evaluate as evaluate
from .model import reflectance as reflectance
from .moments import Moments as Moments
from .registry import from_description as from_description
from .sigmoid import Sigmoid as Sigmoid
