"""Measured reflectances as atlas files, installed as the package ``uplift_atlases``;
README.md describes the files.
"""
