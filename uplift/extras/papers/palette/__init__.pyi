from .colours import illuminant as illuminant
from .design import design as design
from .design import matrix as matrix
from .design import write_designed as write_designed
from .factor import standard_model as standard_model
from .spec import read_palette as read_palette
from .unmet import unmet_goals as unmet_goals
