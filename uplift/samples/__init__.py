"""Sample files: images, scene files, palettes and measurements that the examples of the
documentation use.
"""

from uplift.samples.copy_samples import copy_samples, sample_names, sample_path

__all__ = ["copy_samples", "sample_names", "sample_path"]
