from . import bulk as bulk
from .atlas.atlas import Atlas as Atlas
from .atlas.atlas import Entry as Entry
from .atlas.sources import read_atlas as read_atlas
from .atlas.sources import write_atlas as write_atlas
from .common.errors import (
    AtlasError as AtlasError,
)
from .common.errors import (
    ChartFileError as ChartFileError,
)
from .common.errors import (
    ColourError as ColourError,
)
from .common.errors import (
    CubeFileError as CubeFileError,
)
from .common.errors import (
    LookError as LookError,
)
from .common.errors import (
    OptionError as OptionError,
)
from .common.errors import (
    OutputError as OutputError,
)
from .common.errors import (
    PaintError as PaintError,
)
from .common.errors import (
    PaletteError as PaletteError,
)
from .common.errors import (
    PassesError as PassesError,
)
from .common.errors import (
    PlanFileError as PlanFileError,
)
from .common.errors import (
    TextureError as TextureError,
)
from .common.errors import (
    UnknownNameError as UnknownNameError,
)
from .common.errors import (
    UpliftError as UpliftError,
)
from .common.errors import (
    UpliftWarning as UpliftWarning,
)
from .extras.emission.build import build_emission as build_emission
from .extras.emission.lamps import read_lamp as read_lamp
from .extras.emission.lookup import EmissionTable as EmissionTable
from .extras.emission.lookup import load_emission as load_emission
from .extras.looks.look import Look as Look
from .extras.looks.look import read_looks as read_looks
from .lookup.cube import Cube as Cube
from .lookup.cube import load as load
from .pipeline.build import build as build
from .pipeline.options import Options as Options

__version__: str
