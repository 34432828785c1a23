"""Planner and homing as modules of their own: ours, and the type of those that take their place.

A realtime module named by [TRAJ]TPMOD or [EMCMOT]HOMEMOD is loaded before motmod and offers its table of functions:

    def load(host, args):
        comp = host.component("mytp")
        host.provide("planner", planner_module("mytp", &table))      # or "homing", homing_module(...)
        comp.ready()

The table is copied; the functions must stay as long as the process, which those of an extension module do.
"""

from emcmot.homing cimport homing_interface
from emcmot.tp.interface cimport tp_interface

from emcmot.layout import same_size

same_size(__name__, "TpInterface", sizeof(TpInterface))
same_size(__name__, "HomingInterface", sizeof(HomingInterface))


cdef class PlannerModule:
    """A trajectory planner."""


cdef class HomingModule:
    """A way to home joints."""


cdef PlannerModule planner_module(str name, const TpInterface* table):
    cdef PlannerModule made = PlannerModule()
    made.name = name
    made.table = table[0]
    return made


cdef HomingModule homing_module(str name, const HomingInterface* table):
    cdef HomingModule made = HomingModule()
    made.name = name
    made.table = table[0]
    return made


PLANNER = planner_module("tpmod", tp_interface())
HOMING = homing_module("homemod", homing_interface())
