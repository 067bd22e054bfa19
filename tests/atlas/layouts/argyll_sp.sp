SPECT

MEAS_TYPE "REFLECTIVE"
SPECTRAL_BANDS "{{ columns|length }}"
SPECTRAL_START_NM "{{ columns[0][0] }}.0"
SPECTRAL_END_NM "{{ columns[-1][0] }}.0"
SPECTRAL_NORM "100.0"

NUMBER_OF_FIELDS {{ columns|length }}
BEGIN_DATA_FORMAT
{{ labels("SPEC_{}", " ") }}
END_DATA_FORMAT

NUMBER_OF_SETS 1
BEGIN_DATA
{{ row(atlas[0].values, " ", 100) }}
END_DATA
