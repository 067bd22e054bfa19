{# Keys, then columns without labels: wavelength, radiances of reference and target, percent. #}
/*** Spectra Vista SIG Data ***/
name= C:\data\{{ atlas[0].name }}.sig
instrument= HI: 0000000 (HR-1024i)
integration= 10.0, 20.0, 10.0, 10.0, 20.0, 10.0
units= Radiance, Radiance
time= 6/16/2024 10:42:00 AM, 6/16/2024 10:43:01 AM
factors= 1.003, 1.001, 1.000 [Overlap: Remove @ 990,1900]
data= 
{% for nm, values in columns %}
{{ nm }}.0  250131.25  {{ 1000 * values[0] }}  {{ row(values, " ", 100) }}
{% endfor %}
