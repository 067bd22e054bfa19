"""Studies of the choices behind the models: moments, held-out measurements, stability and sensitivity of builds."""

__all__: list[str] = []
