"""The memory of one motion controller and its two functions, without HAL or NML."""

from emcmot.kins.kinematics cimport KinematicsModule
from emcmot.modules cimport HomingModule, PlannerModule
from emcmot.state cimport Motion


cdef class Core:
    cdef Motion* m
    cdef readonly KinematicsModule kinematics
    cdef readonly PlannerModule planner
    cdef readonly HomingModule homing
    cdef readonly list pins
