"""Temperatures from converters that are read bit by bit: max31855. See ``declare.py``.

The converter measures a type K thermocouple and takes it for linear; the voltage that it must have seen, against the
temperature of its own cold end, gives the true temperature by the polynomials of NIST's ITS-90 tables.
"""

from libc.math cimport exp
from libc.stdint cimport int32_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, U32, declare, pin_in, pin_out

cdef enum:
    SENSORS = 15
    SELECTED = 65  # calls that the chip is selected, and then is not
    CYCLE = 130
    FIRST_BIT = 3  # the call of its first bit; one comes each second call
    FAULTS = 7
    TERMS = 11

cdef double SENSITIVITY = 0.041276  # mV/K, what the chip assumes
cdef double COLDEST = -5.891, WARMEST = 54.886  # mV, between which the tables go
cdef double ABSOLUTE_ZERO = -273.15

cdef enum Table:
    VOLTAGE_BELOW  # mV for degrees Celsius, below zero and above; there with an exponential term
    VOLTAGE_ABOVE
    COLD  # degrees Celsius for mV, below 0 mV, up to 20.644 mV, and above
    WARM
    HOT
    TABLES

POLYNOMIALS = {
    VOLTAGE_BELOW: (
        0.0, 0.394501280250e-01, 0.236223735980e-04, -0.328589067840e-06, -0.499048287770e-08, -0.675090591730e-10,
        -0.574103274280e-12, -0.310888728940e-14, -0.104516093650e-16, -0.198892668780e-19, -0.163226974860e-22),
    VOLTAGE_ABOVE: (
        -0.176004136860e-01, 0.389212049750e-01, 0.185587700320e-04, -0.994575928740e-07, 0.318409457190e-09,
        -0.560728448890e-12, 0.560750590590e-15, -0.320207200030e-18, 0.971511471520e-22, -0.121047212750e-25),
    COLD: (0.0, 2.5173462e1, -1.1662878, -1.0833638, -8.9773540e-1, -3.7342377e-1, -8.6632643e-2, -1.0450598e-2,
           -5.1920577e-4),
    WARM: (0.0, 2.508355e1, 7.860106e-2, -2.503131e-1, 8.315270e-2, -1.228034e-2, 9.804036e-4, -4.413030e-5,
           1.057734e-6, -1.052755e-8),
    HOT: (-1.318058e2, 4.830222e1, -1.646031, 5.464731e-2, -9.650715e-4, 8.802193e-6, -3.110810e-8),
}

cdef double factors[TABLES][TERMS]
cdef int table_number, term_number
for table_number, terms in POLYNOMIALS.items():
    for term_number in range(TERMS):
        factors[table_number][term_number] = terms[term_number] if term_number < len(terms) else 0.0

cdef struct Max31855:
    hal_pin data_in[SENSORS]
    hal_pin cs_out, clk_out
    hal_pin temp_celsius[SENSORS]
    hal_pin temp_fahrenheit[SENSORS]
    hal_pin temp_kelvin[SENSORS]
    hal_pin fault[SENSORS]
    hal_pin fault_flags[SENSORS]
    size_t personality
    int32_t calls  # of this cycle
    uint32_t word[SENSORS]


cdef double polynomial(int table, double x) noexcept nogil:
    cdef double value = 0.0
    cdef int i
    for i in range(TERMS - 1, -1, -1):
        value = value * x + factors[table][i]
    return value

cdef double voltage(double celsius) noexcept nogil:
    """mV of a type K thermocouple whose other end is at 0 degrees."""
    if celsius < 0.0:
        return polynomial(VOLTAGE_BELOW, celsius)
    return polynomial(VOLTAGE_ABOVE, celsius) + 0.1185976 * exp(-0.1183432e-3 * (celsius - 126.9686) ** 2)

cdef double temperature(double seen, double cold_end) noexcept nogil:
    """Degrees Celsius for what the chip tells; the same where the tables end."""
    cdef double volts = SENSITIVITY * (seen - cold_end) + voltage(cold_end)
    if volts < COLDEST or volts > WARMEST:
        return seen
    return polynomial(COLD if volts < 0.0 else WARM if volts <= 20.644 else HOT, volts)

cdef void convert(Max31855* s, int i) noexcept nogil:
    """One sensor's word of 32 bits; a fault leaves the temperatures as they were."""
    cdef uint32_t word = s.word[i]
    cdef double celsius
    at(s.fault_flags[i]).u = word & FAULTS
    at(s.fault[i]).b = word & FAULTS != 0
    if word & FAULTS:
        return
    celsius = temperature((<int32_t>word >> 18) / 4.0, (<int32_t>(word << 16) >> 20) / 16.0)
    at(s.temp_celsius[i]).f = celsius
    at(s.temp_fahrenheit[i]).f = celsius * 1.8 + 32.0
    at(s.temp_kelvin[i]).f = celsius - ABSOLUTE_ZERO

cdef void bitbang_spi(Max31855* s, long period) noexcept nogil:
    cdef int32_t now = s.calls - 1
    cdef int i, sensors = s.personality & SENSORS
    if FIRST_BIT <= now <= SELECTED and now & 1:
        for i in range(sensors):
            s.word[i] = s.word[i] << 1 | (at(s.data_in[i]).b != 0)
            if now == SELECTED:
                convert(s, i)
    at(s.cs_out).b = now >= SELECTED
    at(s.clk_out).b = now & 1
    s.calls = s.calls + 1 if now < CYCLE - 1 else 1

def sensors(int p) -> int:
    """How many converters share clock and selection."""
    return p & SENSORS

declare("max31855", "Temperatures of up to 15 MAX31855 converters at plain pins; personality= says how many there are",
        sizeof(Max31855), [
    pin_in(BIT, "data.{}.in", "what the converter sends", count=SENSORS, personal=sensors),
    pin_out(BIT, "cs.out", "selects the converters while false"), pin_out(BIT, "clk.out", "their clock"),
    pin_out(FLOAT, "temp-celsius.{}", "temperature", count=SENSORS, personal=sensors),
    pin_out(FLOAT, "temp-fahrenheit.{}", "the same", count=SENSORS, personal=sensors),
    pin_out(FLOAT, "temp-kelvin.{}", "the same", count=SENSORS, personal=sensors),
    pin_out(BIT, "fault.{}", "the thermocouple is broken; the temperatures stay", count=SENSORS, personal=sensors),
    pin_out(U32, "fault-flags.{}", "1 open, 2 short to ground, 4 short to the supply", count=SENSORS, personal=sensors),
], {"bitbang-spi": <size_t>&bitbang_spi}, personality=0, keep_personality=True)
