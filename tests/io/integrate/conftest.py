"""Code of the integration pages."""

collect_ignore = ["in_blender.py"]
