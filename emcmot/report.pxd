"""Texts for the operator out of the servo cycle: fixed slots that are drained into emcmotError after each function."""

from emcmot._messages cimport EMCMOT_ERROR, EMCMOT_ERROR_TYPE
from emcmot.state cimport ERRORS, Motion

cdef enum:
    TEXT_SIZE = 256
    KIND_ERROR = 11


cdef inline char* report(Motion* m, int joint=-1, long move_id=0) noexcept nogil:
    """Where to write the next text (TEXT_SIZE bytes); the last slot catches what is lost in a flood."""
    cdef EMCMOT_ERROR* slot = &m.errors[m.error_count]
    if m.error_count < ERRORS - 1:
        m.error_count += 1
    slot.nml_type = EMCMOT_ERROR_TYPE
    slot.nml_size = sizeof(EMCMOT_ERROR)
    slot.echo_serial_number = 0
    slot.kind = KIND_ERROR
    slot.joint = joint
    slot.id = move_id
    return &slot.text[0]
