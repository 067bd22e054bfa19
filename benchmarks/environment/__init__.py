"""The ColorChecker rendered under environments of known lamps, and under their RGB uplifted."""
