"""What a shop's own systems are told of a machine: MQTT (``mqtt``) and OPC UA (``opcua``), from one list (``items``).

Both only tell; neither takes orders. Each is a process of its own that the launcher starts when the INI file has its
section, and whose end leaves the machine as it is.
"""
