# HAL of a simulated machine, made from the INI file; options leave parts out. It is executed by hal/basic_sim.py,
# which needs no Tcl, when a configuration says HALFILE = LIB:basic_sim.tcl.
basic_sim $argv
