"""LinuxCNC's package for previews: ``rs274.interpret`` has the callbacks that displays build on.

What a display wants beyond that (OpenGL, Tk) is found in LinuxCNC's own package of this name where it is installed.
"""

from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)

from rs274.interpret import ArcsToSegmentsMixin, Translated

__all__ = ["ArcsToSegmentsMixin", "Translated"]
