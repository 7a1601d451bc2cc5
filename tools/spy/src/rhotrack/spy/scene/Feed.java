// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.io.IOException;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/** Listens to all RHO_ channels. */
public final class Feed implements LCMSubscriber {
    private final LCM lcm;
    private final Decoder decoder;

    /**
     * A URL of null is LCM's default: the environment's LCM_DEFAULT_URL, or its usual multicast
     * group.
     */
    public Feed(String url, Model model) throws IOException {
        decoder = new Decoder(model);
        try {
            lcm = url == null ? new LCM() : new LCM(url);
            lcm.subscribe("RHO_.*", this);
        } catch (IOException | RuntimeException e) {
            // LCM throws either for a network that it cannot open.
            throw new IOException("no connection to LCM: " + e.getMessage(), e);
        }
    }

    @Override
    public void messageReceived(LCM from, String channel, LCMDataInputStream in) {
        try {
            byte[] data = new byte[in.available()];
            in.readFully(data);
            decoder.decode(channel, data);
        } catch (IOException | RuntimeException e) {
            // LCM's thread would end with it, and the view with the thread.
            System.err.println("rhotrack: " + channel + ": " + e);
        }
    }

    public void close() {
        lcm.unsubscribe("RHO_.*", this);
        lcm.close();
    }
}
