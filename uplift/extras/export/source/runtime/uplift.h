#include "runtime/head.h"
#include "runtime/file.c"
#include "runtime/content.c"
#include "runtime/table.c"
#include "runtime/build.c"

#include "loops.c"
#include "host.c"
#include "runtime/kernel_macros.h"
#include "rows.c"
${lookups}
#include "runtime/calls.c"
#include "loops_end.c"
#endif
#endif
