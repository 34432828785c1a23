"""Outputs that change in step with the motion: what M62 to M65, M67 and M68 attach to a segment."""

from libc.stdint cimport int64_t

ctypedef struct TpIo:
    int64_t dout_mask        # bit n: dout n is set
    int64_t dout_value
    int64_t aout_mask
    double aout_value[64]
