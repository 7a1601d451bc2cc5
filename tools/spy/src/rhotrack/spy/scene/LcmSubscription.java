// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.io.IOException;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/** Subscription to all RHO_ channels of an LCM network; passes their messages to a decoder. */
public final class LcmSubscription implements LCMSubscriber {
    private final LCM lcm;
    private final MessageDecoder decoder;

    /**
     * Subscribes on the network of the URL; null: LCM's default, which is LCM_DEFAULT_URL or its
     * usual multicast group.
     */
    public LcmSubscription(String url, Model model) throws IOException {
        decoder = new MessageDecoder(model);
        try {
            lcm = url == null ? new LCM() : new LCM(url);
            lcm.subscribe("RHO_.*", this);
        } catch (IOException | RuntimeException e) {
            // LCM throws either of them where it cannot open the network.
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
            // an exception would end LCM's thread, and no more messages would arrive
            System.err.println("rhotrack: " + channel + ": " + e);
        }
    }

    public void close() {
        lcm.unsubscribe("RHO_.*", this);
        lcm.close();
    }
}
