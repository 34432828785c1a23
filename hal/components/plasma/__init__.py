"""The parts of the plasma torch's controller, `plasmac`: see ``plasmac.pyx`` beside this folder."""
