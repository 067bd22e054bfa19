"""Everything outside the core, a room for each subject; the core imports none of it.

- files and what they state: `files`, `formats`, `images`, `colour`
- pictures: `texture`, `photographs`, `looks`, `relight`, `mitsuba`, `emission`
- paint: `paint`
- choices for a scene: `scene` (plan, advice, passes)
- answers judged: `report`; timings: `timing`
- output for other programs and people: `export`, `pages`
- methods of documents: `papers`, `thesis`

Not here: spectrum models, the fit, cubes and lookups, which are the core, and
measurements of methods, which are `uplift.lab`.
"""
