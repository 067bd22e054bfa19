from .files import SceneFile as SceneFile
from .files import read_scene_file as read_scene_file
from .planning import Plan as Plan
from .planning import plan as plan
