"""Pins and a function of the kinematics that are made from LinuxCNC's template (userkins.comp), to be like them.

``NAME.in`` is echoed to ``NAME.out`` by the inverse kinematics; ``NAME.param-rw`` and ``NAME.param-ro`` are of no effect.
The function ``NAME.0.fdemo`` counts the pin ``NAME.0.fpin`` up in each period.
"""

from libc.stdint cimport uintptr_t

from hal.cell cimport hal_at, hal_pin

from emcmot.kins.kinematics import Value, provide
from hal import HAL_OUT, HAL_S32

PARAMETERS = (Value("in", type="u32"), Value("param-rw", direction="PARAM"))
OUTPUTS = (Value("out", type="u32", direction="OUT"), Value("param-ro", direction="PARAM"))


cdef void count_up(void* arg, long period_ns) noexcept nogil:
    hal_at(<hal_pin>arg).s += 1


def provide_with_demo(host, module) -> None:
    """Register the kinematics with its pins and with the demonstration."""

    def add(comp):
        pin = comp.pin(f"{module.name}.0.fpin", HAL_S32, HAL_OUT)
        comp.function(f"{module.name}.0.fdemo", <uintptr_t><void*>count_up, pin.address)

    provide(host, module, add)
