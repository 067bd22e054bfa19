"""Answers compared with those expected: of a cube with measured spectra (report), with
its rebuild (check), with another cube (diff), of another program with a cube
(conformance), and pages in which a browser relights.

Errors of other methods on measurements that were left out are in `uplift.lab`, facts
about a cube file in `uplift.cube.file`.
"""
