"""What docs/wavelengths.md says above its tables."""

INTRODUCTION = """# As few wavelengths as a scene needs

{materials} {smooth} {spiky} {smooth_seen} {spiky_seen} {smooth_one} {spiky_one}
"""
