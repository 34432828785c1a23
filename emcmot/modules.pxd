"""Modules that motion can be given in place of its own parts: see ``modules.pyx``."""

from emcmot.state cimport HomingInterface
from emcmot.tp.interface cimport TpInterface


cdef class PlannerModule:
    cdef readonly str name
    cdef TpInterface table


cdef class HomingModule:
    cdef readonly str name
    cdef HomingInterface table


cdef PlannerModule planner_module(str name, const TpInterface* table)
cdef HomingModule homing_module(str name, const HomingInterface* table)
