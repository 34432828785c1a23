"""Pins and a function of the kinematics that are made from LinuxCNC's template."""

from emcmot.kins.kinematics cimport Kinematics

cdef enum:   # places of Kinematics.parameter and .output
    TEMPLATE_IN = 0
    TEMPLATE_OUT = 0

cdef inline void echo(const Kinematics* kins) noexcept nogil:
    """Show the pin ``in`` on the pin ``out``."""
    kins.output[TEMPLATE_OUT] = kins.parameter[TEMPLATE_IN]
