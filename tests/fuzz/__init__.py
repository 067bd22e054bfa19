"""Input that means harm, one file per target, outside the default run (`make nightly`): docs/data/stability-hostile.json."""
