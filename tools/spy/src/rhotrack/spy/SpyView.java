// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.event.ActionEvent;
import java.io.IOException;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JOptionPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

import rhotrack.spy.scene.Decoder;
import rhotrack.spy.scene.Feed;
import rhotrack.spy.scene.LcmUrl;
import rhotrack.spy.scene.Model;

/**
 * The plug-in that lcm-spy finds on its class path: any channel of rhotrack opens the one window
 * that shows all.
 */
public final class SpyView implements SpyPlugin {
    private ViewerWindow window;

    @Override
    public boolean canHandle(long fingerprint) {
        return Decoder.knows(fingerprint);
    }

    @Override
    @SuppressWarnings("serial") // nobody stores actions
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new AbstractAction("rhotrack view") {
            @Override
            public void actionPerformed(ActionEvent event) {
                open();
            }
        };
    }

    private void open() {
        if (window != null && window.isOpen()) {
            window.toFront();
            return;
        }
        try {
            Model model = new Model();
            Feed feed = new Feed(LcmUrl.ofThisProcess(), model);
            window = new ViewerWindow(model, feed, Viewer.WIDTH, Viewer.HEIGHT);
            window.open();
        } catch (IOException e) {
            JOptionPane.showMessageDialog(null, e.getMessage(), "rhotrack", JOptionPane.ERROR_MESSAGE);
        }
    }
}
