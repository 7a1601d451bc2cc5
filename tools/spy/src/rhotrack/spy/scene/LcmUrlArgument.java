// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

/**
 * The command-line argument that names the URL of the LCM network; null where there is none, for
 * LCM's default.
 */
public final class LcmUrlArgument {
    private LcmUrlArgument() {
    }

    /** The URL in arguments as lcm-spy takes them: -l URL, --lcm-url URL or --lcm-url=URL. */
    public static String fromArguments(String... arguments) {
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
     * The URL in the arguments of this process: lcm-spy gives plug-ins neither its LCM object nor
     * its URL.
     */
    public static String fromThisProcess() {
        return fromArguments(ProcessHandle.current().info().arguments().orElse(new String[0]));
    }
}
