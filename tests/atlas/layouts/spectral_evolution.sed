{# Radiances beside the reflectance, keys that are about other things. #}
Version: 2.3
Instrument: S1
Detectors: 512,256,256
Measurement: REFLECTANCE
Wavelength Range: 350,2500
Units: W/m^2/sr/nm
Columns [4]:
Data:
Wvl	Rad. (Ref.)	Rad. (Target)	Reflect. %
{% for nm, values in columns %}
{{ nm }}.0	3.1E-03	1.2E-03	{{ row(values, "	", 100) }}
{% endfor %}
