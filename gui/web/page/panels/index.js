/** All panels of the page. A new panel is one module that calls `registerPanel`, and one line here. */

import "./manual.js";
import "./program.js";
import "./mdi.js";
import "./path.js";
import "./offsets.js";
import "./tools.js";
import "./messages.js";
import "./hal.js";
import "./scope.js";
import "./system.js";
import "./wizard.js";
