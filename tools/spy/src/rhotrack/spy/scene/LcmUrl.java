// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

/** Finds the URL of the LCM network, or null for LCM's own default. */
public final class LcmUrl {
    private LcmUrl() {
    }

    /** From arguments as lcm-spy takes them: -l URL, --lcm-url URL or --lcm-url=URL. */
    public static String from(String... arguments) {
        for (int i = 0; i < arguments.length; i++) {
            if (arguments[i].startsWith("--lcm-url=")) {
                return arguments[i].substring("--lcm-url=".length());
            }
            boolean named = arguments[i].equals("-l") || arguments[i].equals("--lcm-url");
            if (named && i + 1 < arguments.length) {
                return arguments[i + 1];
            }
        }
        return null;
    }

    /**
     * lcm-spy tells its plug-ins neither its LCM object nor its URL, but the process has its own
     * arguments.
     */
    public static String ofThisProcess() {
        return from(ProcessHandle.current().info().arguments().orElse(new String[0]));
    }
}
