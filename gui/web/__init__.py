"""The web display: a server that shows and operates a machine in browsers, and a gateway for programs.

``settings`` and ``displaykeys`` read the INI file, ``access`` knows tokens and origins, ``machine`` talks to task,
``state`` is the map that clients see, ``hub`` and ``client`` are the people at the browsers, ``calls`` and the
modules of ``methods`` are what they may ask for, ``jogging`` and ``preview`` do the long work, ``site`` is HTTP.
What goes over the wire: docs/web-protocol.md.
"""
