"""The trajectory planner: a library that knows no bus, no clock and no HAL.

Its C face is ``tp.pxd``, its Python face ``emcmot.tp.planner.Planner``; docs/planner.md says how it works.
"""
