from .delta_e import delta_e_1976 as delta_e_1976
from .delta_e import delta_e_2000 as delta_e_2000
from .delta_e import delta_e_rgb as delta_e_rgb
from .delta_e import delta_e_spectra as delta_e_spectra
from .delta_e import lab as lab
from .sensor import Light as Light
from .sensor import Sensor as Sensor
