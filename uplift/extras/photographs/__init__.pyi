from .answers import Photographs as Photographs
from .answers import prepare as prepare
from .errors import light_errors as light_errors
from .photograph import Noise as Noise
from .photograph import Photograph as Photograph
from .photograph import photograph as photograph
from .samples import SpectrumSampler as SpectrumSampler
from .samples import prepare_samples as prepare_samples
