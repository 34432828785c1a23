"""Messages, the buffers that carry them, and the files that describe both.

The variable PYEMC_LIBRARIES names the folder of what our packages import, for scripts in the system's own Python
(``linuxcnc.systempython``); it is looked in last.
"""

import os
import sys

LIBRARIES = "PYEMC_LIBRARIES"
_folder = os.environ.get(LIBRARIES)
if _folder and _folder not in sys.path:
    sys.path.append(_folder)
